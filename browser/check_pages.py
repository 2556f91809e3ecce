"""The report and the review page in a real browser: on their own, by mouse and keys, in the dark, on paper, read aloud."""

import tempfile
import unittest

import driver
import pages

# Text and the background it stands on, WCAG 2.2, 1.4.3 (AA).
CONTRAST = 4.5

# Narrower than any phone sold today, CSS pixels.
NARROW = 360

# The printable width of A4 with the browser's usual margins, CSS pixels.
PAPER = 718

RIGHT, LEFT, HOME, END, TAB = "\ue014", "\ue012", "\ue011", "\ue010", "\ue004"

# Every visible text with too little contrast: colours are what the browser draws with, opaque layers of the ancestors below
# them. A picture or a gradient has no single colour and ends the search.
FAINT = """
const canvas = document.createElement("canvas").getContext("2d", {willReadFrequently: true});
const rgba = colour => {
  canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1);
  const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
  return [r, g, b, a / 255];
};
const over = (top, below) => [0, 1, 2].map(i => top[i] * top[3] + below[i] * (1 - top[3])).concat(1);
const background = element => {
  const layers = [];
  for (let e = element; e; e = e.parentElement) {
    const style = getComputedStyle(e);
    if (style.backgroundImage !== "none") return null;
    layers.push(rgba(style.backgroundColor));
    if (layers.at(-1)[3] === 1) break;
  }
  return layers.reduceRight((below, layer) => over(layer, below), [255, 255, 255, 1]);
};
const luminance = colour => colour.slice(0, 3).map(v => v / 255)
  .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
  .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
const faint = [];
let seen = 0;
const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (texts.nextNode()) {
  const text = texts.currentNode.data.trim(), element = texts.currentNode.parentElement;
  if (!text || !element.checkVisibility({visibilityProperty: true, opacityProperty: true})) continue;
  if (element.closest(".unseen, script, style, .skip, svg")) continue;
  const below = background(element);
  if (!below) continue;
  const [a, b] = [over(rgba(getComputedStyle(element).color), below), below].map(luminance);
  const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  seen += 1;
  if (contrast < arguments[0]) faint.push(`${contrast.toFixed(2)}: ${element.tagName}.${element.className} "${text.slice(0, 40)}"`);
}
return [seen, faint];
"""

# What a screen reader's user goes by.
OUTLINE = """
const all = (selector) => [...document.querySelectorAll(selector)];
const ids = all("[id]").map(e => e.id);
return {
  lang: document.documentElement.lang,
  title: document.title,
  main: all("main").length,
  levels: all("h1, h2, h3, h4, h5, h6").map(h => Number(h.tagName[1])),
  emptyHeadings: all("h1, h2, h3, h4, h5, h6").filter(h => !h.textContent.trim()).length,
  pictures: all("img, svg[role=img]").length,
  withoutAlt: all("img").filter(i => !i.alt.trim()).map(i => i.outerHTML.slice(0, 80)),
  sameAlt: all("img").map(i => i.alt).filter((alt, i, list) => list.indexOf(alt) !== i),
  twice: ids.filter((id, i) => ids.indexOf(id) !== i),
  dangling: all("[aria-labelledby], [for], a[href^='#']")
    .map(e => e.getAttribute("aria-labelledby") ?? e.getAttribute("for") ?? e.getAttribute("href").slice(1))
    .filter(id => !document.getElementById(decodeURIComponent(id))),
  tablesWithoutHeads: all("table").filter(t => !t.querySelector("thead th[scope=col]")).length,
};
"""

# Where both figures of the first divider are drawn, and how they are cut off.
PAIR = """
const [base, head] = document.querySelectorAll(".slider .stack figure");
const box = e => { const r = e.getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; };
const at = document.querySelector(".slider .stack").getBoundingClientRect();
return {
  base: box(base.querySelector("img")), head: box(head.querySelector("img")), stack: [at.left, at.top, at.right, at.bottom],
  clips: [base, head].map(f => getComputedStyle(f).clipPath),
  captions: [base, head].map(f => f.querySelector("figcaption").checkVisibility()),
  value: document.querySelector(".slider input").value,
};
"""


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.pages = pages.make(folder.name)
        cls.browser = driver.Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.scripts(True)
        self.browser.width(0)
        self.browser.media()

    def each(self):
        """The pages, one after the other, opened."""
        for name, path in self.pages.items():
            self.browser.open(path)
            yield name

    def pair(self):
        return self.browser.script(PAIR)

    def apart(self, pair):
        """Both figures are whole and do not cover each other."""
        self.assertEqual(pair["clips"], ["none", "none"])
        self.assertEqual(pair["captions"], [True, True])
        (left, top, right, bottom), (l, t, r, b) = pair["base"], pair["head"]
        self.assertTrue(right <= l or r <= left or bottom <= t or b <= top, pair)
        self.assertGreater(min(right - left, bottom - top, r - l, b - t), 50, pair)

    def fits(self, name, width):
        """The page is not wider than the window: nothing is cut off, nothing moves sideways."""
        inner = self.browser.script("return document.documentElement.scrollWidth")
        wide = "return [...document.body.querySelectorAll('*')].filter(e => e.getBoundingClientRect().right > arguments[0])" \
            ".map(e => e.outerHTML.slice(0, 90)).slice(0, 5)"
        self.assertLessEqual(inner, width, f"{name}: {self.browser.script(wide, width)}")

    def test_pages_ask_for_nothing_but_their_own_files(self):
        for name in self.pages:
            with self.subTest(page=name):
                self.browser.requests()
                self.browser.log("browser")
                self.browser.open(self.pages[name])
                self.browser.script("return document.images.length")
                asked = self.browser.requests()
                self.assertIn(self.pages[name].as_uri(), asked)
                self.assertEqual([a for a in asked if not a.startswith(("file:", "data:"))], [])
                self.assertEqual(self.browser.log("browser"), [])
                broken = "return [...document.images].filter(i => !i.complete || !i.naturalWidth).map(i => i.alt)"
                self.assertEqual(self.browser.script(broken), [])

    def test_the_review_is_one_file(self):
        self.browser.requests()
        self.browser.open(self.pages["review"])
        self.assertEqual([a for a in self.browser.requests() if a.startswith("file:")], [self.pages["review"].as_uri()])

    def test_outlines_can_be_read_aloud(self):
        for name in self.each():
            found = self.browser.script(OUTLINE)
            self.assertEqual((found["lang"], found["main"], found["levels"].count(1)), ("en", 1, 1))
            self.assertTrue(found["title"])
            self.assertEqual(found["levels"][0], 1)
            skipped = [pair for pair in zip(found["levels"], found["levels"][1:]) if pair[1] > pair[0] + 1]
            self.assertEqual(skipped, [], "a heading level is left out")
            self.assertTrue(found["pictures"] > 0 or name == "pending")
            for fault in ["withoutAlt", "twice", "dangling"]:
                self.assertEqual(found[fault], [], f"{name}: {fault}")
            # Before, after and their difference must be told apart by ear.
            self.assertTrue(name == "report" or not found["sameAlt"], found["sameAlt"])
            for fault in ["emptyHeadings", "tablesWithoutHeads"]:
                self.assertEqual(found[fault], 0, fault)

    def test_dividers_have_names_of_their_own(self):
        self.browser.open(self.pages["review"])
        dividers = self.browser.find_all(".slider input")
        self.assertEqual([self.browser.role(d) for d in dividers], ["slider"] * 4)
        names = {self.browser.label(d).lower() for d in dividers}
        self.assertEqual(len(names), 4, names)
        # Figures of another size have one, too.
        for experiment in ["turning", "growing"]:
            for figure in ["moving", "wide"]:
                words = [figure, experiment, "before", "after"]
                self.assertTrue(any(all(word in name for word in words) for name in names), (words, names))

    def test_the_divider_follows_the_keys(self):
        self.browser.open(self.pages["review"])
        self.assertIn("50%", self.pair()["clips"][1])
        # Reached as everything else is, by the tabulator.
        for _ in range(50):
            self.browser.press(TAB)
            if self.browser.script("return document.activeElement.matches('.slider input')"):
                break
        else:
            self.fail("the divider cannot be reached by the tabulator")
        outline = "return getComputedStyle(document.activeElement).outlineStyle"
        self.assertNotEqual(self.browser.script(outline), "none", "the focus is not seen")
        for keys, percent in [([RIGHT] * 3, 53), ([LEFT], 52), ([HOME], 0), ([END], 100)]:
            self.browser.press(*keys)
            pair = self.pair()
            self.assertEqual((pair["value"], pair["clips"][0]), (str(percent), "none"))
            self.assertRegex(pair["clips"][1], rf" {percent}%\)$" if percent else r"\b0(px|%)")

    def test_the_divider_follows_the_mouse(self):
        self.browser.open(self.pages["review"])
        box = """const e = document.querySelector(arguments[0]); e.scrollIntoView({block: "center"});
            const r = e.getBoundingClientRect(); return [r.left, r.top, r.width, r.height];"""
        left, top, width, height = self.browser.script(box, ".slider input")
        middle = top + height / 2
        self.browser.drag((left + width / 2, middle), (left + width * 0.8, middle))
        self.assertAlmostEqual(int(self.pair()["value"]), 80, delta=3)
        # The line over the figures is taken hold of as well.
        left, top, width, height = self.browser.script(box, ".slider .stack")
        middle = top + height / 2
        self.browser.drag((left + width * 0.8, middle), (left + width * 0.25, middle))
        pair = self.pair()
        self.assertAlmostEqual(int(pair["value"]), 25, delta=2)
        self.assertIn(f" {pair['value']}%)", pair["clips"][1])

    def test_figures_lie_on_each_other(self):
        self.browser.open(self.pages["review"])
        pair = self.pair()
        self.assertEqual(pair["base"], pair["head"])
        # Edge to edge, or the divider would not be where the figures are cut.
        self.assertAlmostEqual(pair["stack"][0], pair["base"][0], delta=1.5)
        self.assertAlmostEqual(pair["stack"][2], pair["base"][2], delta=1.5)

    def test_texts_stand_out_from_their_ground(self):
        for scheme in ["light", "dark"]:
            self.browser.media(scheme=scheme)
            for name in self.each():
                self.browser.script("for (const d of document.querySelectorAll('details')) d.open = true")
                seen, faint = self.browser.script(FAINT, CONTRAST)
                self.assertGreater(seen, 20, f"{name}, {scheme}")
                self.assertEqual(faint, [], f"{name}, {scheme}")

    def test_the_dark_is_dark(self):
        ground = "return getComputedStyle(document.body).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number)"
        for name in self.each():
            self.browser.media(scheme="dark")
            self.assertLess(max(self.browser.script(ground)), 60, name)
            self.browser.media(scheme="light")
            self.assertGreater(min(self.browser.script(ground)), 200, name)

    def test_narrow_windows_need_no_scrolling_sideways(self):
        self.browser.width(NARROW)
        for name in self.each():
            self.fits(name, NARROW)

    def test_paper_shows_what_the_screen_folds_and_covers(self):
        for name in self.each():
            pdf = self.browser.pdf()
            self.assertEqual(pdf[:5], b"%PDF-", name)
            self.assertGreaterEqual(pdf.count(b"/Type /Page\n") + pdf.count(b"/Type/Page\n"), 1, name)
        self.browser.width(PAPER)
        for scheme in ["light", "dark"]:
            self.browser.media("print", scheme)
            for name in self.each():
                self.fits(name, PAPER)
                folded = "return [...document.querySelectorAll('details > :not(summary)')].map(e => e.checkVisibility() && e.offsetHeight)"
                self.assertNotIn(False, self.browser.script(folded), name)
                self.assertNotIn(0, self.browser.script(folded), name)
                _, faint = self.browser.script(FAINT, CONTRAST)
                self.assertEqual(faint, [], f"{name}, {scheme}")
                if name == "review":
                    self.apart(self.pair())

    def test_without_scripts_figures_stand_side_by_side(self):
        self.browser.scripts(False)
        self.browser.open(self.pages["review"])
        self.browser.scripts(True)
        pair = self.pair()
        self.apart(pair)
        self.assertFalse(self.browser.script("return document.querySelector('.slider input').checkVisibility()"))


if __name__ == "__main__":
    unittest.main()
