//! Two `summary.json` and their figures, compared.

use super::picture::{self, Pixels};
use super::{
    Entry, ExperimentReview, FigureReview, Kind, NumberReview, Picture, Review, ReviewError, Side, State,
    Subject, Value,
};
use crate::{CheckOutcome, Expected, ExperimentSummary, FilePath, Summary};
use std::collections::{BTreeMap, BTreeSet};

/// What a `summary.json` holds, as a review compares it; nothing by default.
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
/// # Errors
/// [`ReviewError::Summary`].
pub fn read(file: &str, text: &str) -> Result<Results, ReviewError> {
    let summary = Summary::from_json(file, text)?;
    Ok(Results { experiments: summary.experiments.into_iter().map(experiment).collect() })
}

fn experiment(e: ExperimentSummary) -> Experiment {
    // Seconds never count as movement, drawn or not.
    let counts = |f: &&FilePath| f.as_str().ends_with(".png") && !e.timed_figures.contains(f);
    Experiment {
        title: if e.title.is_empty() { e.slug.clone() } else { e.title },
        seconds: e.seconds.is_finite().then_some(e.seconds),
        figures: e.figures.iter().filter(counts).map(|f| f.as_str().to_owned()).collect(),
        checks: e.checks.into_iter().map(check).collect(),
        work: e.work.0.into_iter().map(|(name, n)| (name, Entry::bare(Value::Number(n as f64)))).collect(),
        slug: e.slug,
    }
}

fn check(check: CheckOutcome) -> (String, Entry) {
    let (Expected::Near { value, .. } | Expected::AtMost(value) | Expected::AtLeast(value)) = check.expected;
    // Older programs did not write it.
    let expected = (!value.is_nan()).then_some(check.expected);
    (check.name, Entry { value: Value::Number(check.value), passed: Some(check.passed), expected })
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
    let unchanged = FigureReview {
        name,
        state: State::Unchanged,
        change: 0.0,
        difference: None,
        sizes: None,
        base: None,
        head: None,
    };
    if base == head {
        return Ok(unchanged);
    }
    let decode = |name: &str, png: &Option<Vec<u8>>| match png {
        Some(png) => Pixels::decode(&format!("{name}/{path}"), png).map(Some),
        None => Ok(None),
    };
    let state = State::of(base.is_some(), head.is_some(), true);
    let (Some(a), Some(b)) = (decode(names[0], &base)?, decode(names[1], &head)?) else {
        let picture = |name: &str, png: Option<Vec<u8>>| -> Result<Option<Picture>, ReviewError> {
            let Some(png) = png else { return Ok(None) };
            Ok(Some(Pixels::decode(&format!("{name}/{path}"), &png)?.picture(png)))
        };
        let (base, head) = (picture(names[0], base)?, picture(names[1], head)?);
        return Ok(FigureReview { state, change: f64::INFINITY, base, head, ..unchanged });
    };
    let sizes = (a.size() != b.size()).then(|| [a.size(), b.size()]);
    let difference = picture::difference(&a, &b);
    if difference.differing == 0 && sizes.is_none() {
        return Ok(FigureReview { difference: Some(difference), ..unchanged });
    }
    // Pictures of one size are shown as they are.
    let shown = |pixels: Pixels, png: Option<Vec<u8>>| match sizes {
        None => png.map(|png| pixels.picture(png)),
        Some(_) => Some(pixels.padded(difference.size).encoded()),
    };
    Ok(FigureReview {
        state,
        change: difference.mean,
        sizes,
        base: shown(a, base),
        head: shown(b, head),
        difference: Some(difference),
        ..unchanged
    })
}
