//! Two `summary.json` and their figures, compared.

use super::picture::{self, Pixels};
use super::{
    Entry, ExperimentReview, FigureReview, Kind, NumberReview, Picture, Review, ReviewError, Side, State,
    Subject, Value,
};
use serde_json::Value as Json;
use std::collections::{BTreeMap, BTreeSet};

/// Longest list in a summary.
const MAX_ITEMS: usize = 100_000;

/// Longest name in a summary, bytes.
const MAX_NAME: usize = 10_000;

/// What a `summary.json` holds; nothing by default.
#[derive(Clone, Debug, Default)]
pub struct Results {
    experiments: Vec<Experiment>,
}

impl Results {
    /// Names of the experiments.
    pub fn slugs(&self) -> impl Iterator<Item = &str> {
        self.experiments.iter().map(|e| e.slug.as_str())
    }

    /// Keeps the experiments of these names; all where there is no name.
    #[must_use]
    pub fn only(mut self, slugs: &[String]) -> Self {
        self.experiments.retain(|e| slugs.is_empty() || slugs.contains(&e.slug));
        self
    }
}

#[derive(Clone, Debug)]
struct Experiment {
    slug: String,
    title: String,
    seconds: Option<f64>,
    /// Paths of PNG files.
    figures: Vec<String>,
    checks: Vec<(String, Entry)>,
    work: Vec<(String, Entry)>,
}

/// Reads the text of a `summary.json`; `file` names it in messages.
///
/// Numbers that are `null` are not a number. What older programs did not write (`title`, `seconds`, `figures`, `work`,
/// `expected`) may be missing.
///
/// # Errors
/// [`ReviewError::Json`], [`ReviewError::Key`].
pub fn read(file: &str, text: &str) -> Result<Results, ReviewError> {
    let json: Json = serde_json::from_str(text)
        .map_err(|e| ReviewError::Json { file: file.to_owned(), problem: e.to_string() })?;
    let root = At { file, key: String::new(), value: &json };
    let list = root.need("experiments")?;
    let experiments = list.items()?.iter().map(experiment).collect::<Result<Vec<_>, _>>()?;
    let mut slugs = BTreeSet::new();
    for (i, e) in experiments.iter().enumerate() {
        if !slugs.insert(&e.slug) {
            return Err(list.fault_at(&format!("[{i}].slug"), "a name that no other experiment has"));
        }
    }
    Ok(Results { experiments })
}

fn experiment(at: &At<'_>) -> Result<Experiment, ReviewError> {
    let slug = at.need("slug")?.words()?;
    let figures = match at.get("figures") {
        None => Vec::new(),
        Some(list) => list.items()?.iter().map(At::path).collect::<Result<Vec<_>, _>>()?,
    };
    // Seconds never count as movement, drawn or not.
    let timed = match at.get("timed_figures") {
        None => Vec::new(),
        Some(list) => list.items()?.iter().map(At::path).collect::<Result<Vec<_>, _>>()?,
    };
    let work = match at.get("work") {
        None => Vec::new(),
        Some(counters) => counters.members()?,
    };
    Ok(Experiment {
        title: at.get("title").map_or_else(|| Ok(slug.clone()), |t| t.words())?,
        seconds: at.get("seconds").map(|s| s.number()).transpose()?,
        figures: figures.into_iter().filter(|f| f.ends_with(".png") && !timed.contains(f)).collect(),
        checks: at.need("checks")?.items()?.iter().map(check).collect::<Result<_, _>>()?,
        work: work
            .iter()
            .map(|(name, n)| Ok((name.clone(), Entry::bare(Value::Number(n.number()?)))))
            .collect::<Result<_, ReviewError>>()?,
        slug,
    })
}

fn check(at: &At<'_>) -> Result<(String, Entry), ReviewError> {
    let number = |key: &str| at.get(key).map(|n| n.number()).transpose();
    let kind = at.get("kind").map(|k| k.words()).transpose()?;
    let expected = number("expected")?.map(|value| {
        let tolerance = number("tolerance")?.unwrap_or(0.0);
        Ok(match kind.as_deref() {
            Some(bound @ ("at most" | "at least")) => format!("{bound} {}", short(value)),
            _ if tolerance == 0.0 => format!("exactly {}", short(value)),
            _ => format!("{} ± {}", short(value), short(tolerance)),
        })
    });
    let entry = Entry {
        value: Value::Number(at.need("value")?.number()?),
        passed: Some(at.need("passed")?.flag()?),
        expected: expected.transpose()?,
    };
    Ok((at.need("name")?.words()?, entry))
}

/// All digits, with a power of ten where there would be many zeros.
fn short(x: f64) -> String {
    if x == 0.0 || (1e-4..1e15).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// A value and its place in a file.
struct At<'a> {
    file: &'a str,
    key: String,
    value: &'a Json,
}

impl<'a> At<'a> {
    fn fault(&self, expected: impl Into<String>) -> ReviewError {
        ReviewError::Key { file: self.file.to_owned(), key: self.key.clone(), expected: expected.into() }
    }

    fn fault_at(&self, below: &str, expected: &str) -> ReviewError {
        let key = format!("{}{below}", self.key);
        ReviewError::Key { file: self.file.to_owned(), key, expected: expected.to_owned() }
    }

    fn get(&self, name: &str) -> Option<Self> {
        let value = self.value.get(name)?;
        let dot = if self.key.is_empty() { "" } else { "." };
        Some(Self { file: self.file, key: format!("{}{dot}{name}", self.key), value })
    }

    fn need(&self, name: &str) -> Result<Self, ReviewError> {
        let dot = if self.key.is_empty() { "" } else { "." };
        self.get(name).ok_or_else(|| self.fault_at(&format!("{dot}{name}"), "a value, which is missing"))
    }

    fn items(&self) -> Result<Vec<Self>, ReviewError> {
        let items = self.value.as_array().ok_or_else(|| self.fault("a list"))?;
        if items.len() > MAX_ITEMS {
            return Err(self.fault(format!("at most {MAX_ITEMS} entries")));
        }
        let at = |(i, value): (usize, &'a Json)| Self {
            file: self.file,
            key: format!("{}[{i}]", self.key),
            value,
        };
        Ok(items.iter().enumerate().map(at).collect())
    }

    fn members(&self) -> Result<Vec<(String, Self)>, ReviewError> {
        let members = self.value.as_object().ok_or_else(|| self.fault("an object"))?;
        if members.len() > MAX_ITEMS {
            return Err(self.fault(format!("at most {MAX_ITEMS} entries")));
        }
        let at = |(name, value): (&String, &'a Json)| {
            let key = format!("{}.{}", self.key, crate::shortened(name));
            (name.clone(), Self { file: self.file, key, value })
        };
        Ok(members.iter().map(at).collect())
    }

    fn words(&self) -> Result<String, ReviewError> {
        match self.value.as_str() {
            Some(words) if words.len() <= MAX_NAME => Ok(words.to_owned()),
            Some(_) => Err(self.fault(format!("at most {MAX_NAME} bytes of text"))),
            None => Err(self.fault("text")),
        }
    }

    fn number(&self) -> Result<f64, ReviewError> {
        match self.value {
            Json::Null => Ok(f64::NAN),
            Json::Number(n) => n.as_f64().ok_or_else(|| self.fault("a number or null")),
            _ => Err(self.fault("a number or null")),
        }
    }

    fn flag(&self) -> Result<bool, ReviewError> {
        self.value.as_bool().ok_or_else(|| self.fault("true or false"))
    }

    /// A path that stays in the results folder.
    fn path(&self) -> Result<String, ReviewError> {
        let path = self.words()?;
        let inside = path.split('/').all(|part| !["", ".", ".."].contains(&part))
            && !path.chars().any(|c| c == '\\' || c == ':' || c.is_control());
        if inside { Ok(path) } else { Err(self.fault("the path of a file below the results folder")) }
    }
}

/// Reads a figure's PNG by its path in the summary of one side.
pub type ReadFigure<'a, E> = dyn FnMut(Side, &str) -> Result<Vec<u8>, E> + 'a;

/// Compares two results. `names` are those of base and head.
///
/// # Errors
/// What `figure` fails with; [`ReviewError::Picture`].
pub fn results<E: From<ReviewError>>(
    names: [&str; 2],
    base: &Results,
    head: &Results,
    tolerance: f64,
    figure: &mut ReadFigure<'_, E>,
) -> Result<Review, E> {
    let by_slug = |e: &Experiment| e.slug.clone();
    let mut reviews = Vec::new();
    for (slug, a, b) in paired(&base.experiments, &head.experiments, by_slug) {
        let title = b.or(a).map_or("", |e| e.title.as_str());
        let mut numbers = reviewed(Kind::Check, [a, b].map(|e| e.map_or(&[][..], |e| &e.checks)), tolerance);
        // Counters that the program did not write yet are not movement.
        if a.is_some_and(|e| !e.work.is_empty()) && b.is_some_and(|e| !e.work.is_empty()) {
            numbers.extend(reviewed(Kind::Work, [a, b].map(|e| e.map_or(&[][..], |e| &e.work)), tolerance));
        }
        let mut figures = Vec::new();
        let of = |e: Option<&Experiment>| e.map_or_else(Vec::new, |e| e.figures.clone());
        for (path, x, y) in paired(&of(a), &of(b), String::clone) {
            let mut read = |side, there: bool| match there {
                true => figure(side, &path).map(Some),
                false => Ok(None),
            };
            let pngs = [read(Side::Base, x.is_some())?, read(Side::Head, y.is_some())?];
            figures.push(figure_review(names, &slug, &path, pngs)?);
        }
        let there = [a.is_some(), b.is_some()];
        let mut review = ExperimentReview::new(&slug, title, there, numbers).with_figures(figures);
        review.base_seconds = a.and_then(|e| e.seconds);
        review.head_seconds = b.and_then(|e| e.seconds);
        reviews.push(review);
    }
    Ok(Review::new(names, tolerance, Subject::Results, reviews))
}

fn reviewed(kind: Kind, [base, head]: [&[(String, Entry)]; 2], tolerance: f64) -> Vec<NumberReview> {
    let entry = |e: Option<&(String, Entry)>| e.map(|(_, e)| e.clone());
    paired(base, head, |(name, _)| name.clone())
        .into_iter()
        .map(|(name, a, b)| NumberReview::new(name, kind, entry(a), entry(b), tolerance))
        .collect()
}

/// Entries of one name beside each other: those of `head` in their order, then those that are gone. Of several entries
/// of one name the first belong together, then the second ones, which get a number.
pub(super) fn paired<'a, T>(
    base: &'a [T],
    head: &'a [T],
    name: impl Fn(&T) -> String,
) -> Vec<(String, Option<&'a T>, Option<&'a T>)> {
    let numbered = |list: &'a [T]| {
        let mut counts = BTreeMap::<String, usize>::new();
        let number = |entry: &'a T| {
            let name = name(entry);
            let count = counts.entry(name.clone()).or_default();
            *count += 1;
            ((name, *count), entry)
        };
        list.iter().map(number).collect::<Vec<_>>()
    };
    let (base, head) = (numbered(base), numbered(head));
    let before: BTreeMap<_, _> = base.iter().map(|(key, entry)| (key, *entry)).collect();
    let after: BTreeSet<_> = head.iter().map(|(key, _)| key).collect();
    let label = |(name, n): &(String, usize)| if *n == 1 { name.clone() } else { format!("{name} ({n})") };
    let there = head.iter().map(|(key, entry)| (label(key), before.get(key).copied(), Some(*entry)));
    let gone = base.iter().filter(|(key, _)| !after.contains(key));
    there.chain(gone.map(|(key, entry)| (label(key), Some(*entry), None))).collect()
}

fn figure_review(
    names: [&str; 2],
    slug: &str,
    path: &str,
    [base, head]: [Option<Vec<u8>>; 2],
) -> Result<FigureReview, ReviewError> {
    let short = path.strip_prefix(slug).and_then(|p| p.strip_prefix('/')).unwrap_or(path);
    let name = short.strip_suffix(".png").unwrap_or(short).to_owned();
    let unchanged =
        FigureReview { name, state: State::Unchanged, change: 0.0, difference: None, base: None, head: None };
    if base == head {
        return Ok(unchanged);
    }
    let decode = |name: &str, png: &Option<Vec<u8>>| match png {
        Some(png) => Pixels::decode(&format!("{name}/{path}"), png).map(Some),
        None => Ok(None),
    };
    let pixels = [decode(names[0], &base)?, decode(names[1], &head)?];
    let difference = match &pixels {
        [Some(a), Some(b)] => picture::difference(a, b),
        _ => None,
    };
    if difference.as_ref().is_some_and(|d| d.differing == 0) {
        return Ok(FigureReview { difference, ..unchanged });
    }
    let picture = |png: Option<Vec<u8>>, pixels: &Option<Pixels>| -> Option<Picture> {
        Some(pixels.as_ref()?.picture(png?))
    };
    Ok(FigureReview {
        state: State::of(base.is_some(), head.is_some(), true),
        change: difference.as_ref().map_or(f64::INFINITY, |d| d.mean),
        base: picture(base, &pixels[0]),
        head: picture(head, &pixels[1]),
        difference,
        ..unchanged
    })
}
