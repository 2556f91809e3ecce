//! Tables from results.

use crate::comparison::{chance_of, distances, map_correlation};
use crate::measure::{gradient_difference, summary};
use crate::pulses::PulseRecord;
use crate::runs::Results;
use crate::spec::{
    self, ComparisonRow, GradientRow, MapSource, NoiseRow, PulseNumber, RidgeSource, RuntimeRow, Summary,
    TableRows,
};
use tigereye_ltg::LtgOutcome;
use tigereye_report::{Column, Table};

/// What stands where there is nothing to say.
const NOTHING: &str = "\u{2013}";
/// What stands between the ends of a range.
const RANGE: &str = "\u{2013}";

pub(crate) fn table(table: &spec::Table, results: &Results) -> Table {
    let (columns, rows) = match &table.rows {
        TableRows::Pulses { runs } => (pulse_columns(), rows(runs, |run| pulse_row(run, results))),
        TableRows::Gradients { first, second, rows: pairs } => {
            (gradient_columns(first, second), rows(pairs, |pair| gradient_row(pair, results)))
        }
        TableRows::Comparison { rows: pairs } => {
            (comparison_columns(), rows(pairs, |pair| comparison_row(pair, results)))
        }
        TableRows::Noise { rows: pairs } => (noise_columns(), rows(pairs, |pair| noise_row(pair, results))),
        TableRows::Runtimes { rows: times } => {
            (runtime_columns(), rows(times, |t| Some(runtime_row(t, results))))
        }
    };
    Table { title: table.title.clone(), caption: table.caption.clone(), columns, rows }
}

/// A row's name and entries.
type Row = (String, Vec<String>);

fn rows<T>(of: &[T], row: impl Fn(&T) -> Option<Row>) -> Vec<Row> {
    of.iter().filter_map(row).collect()
}

/// Columns: words first, then numbers.
fn columns(headings: &[&str]) -> Vec<Column> {
    let column = |(i, heading): (usize, &&str)| Column { heading: (*heading).to_owned(), words: i == 0 };
    headings.iter().enumerate().map(column).collect()
}

fn pulse_columns() -> Vec<Column> {
    columns(&[
        "Run",
        "Pulses",
        "Plain steps",
        "Evaluations by the solver",
        "Times fewer",
        "Steps under the rule",
        "Distance of that state /\u{a0}%",
        "Energy it lacks /\u{a0}%",
        "Error of plain steps",
        "Error of the solver",
    ])
}

fn pulse_row(run: &String, results: &Results) -> Option<Row> {
    use PulseNumber as N;
    let pulses = results.pulses.get(run)?;
    let of = |number, over| summary(&[pulses], number, over);
    let range = |number, shown: fn(f64) -> String| {
        let [mean, least, most] =
            [Summary::Mean, Summary::Least, Summary::Most].map(|over| shown(of(number, over)));
        if least == most { mean } else { format!("{mean} ({least}{RANGE}{most})") }
    };
    let entries = vec![
        settled(pulses),
        range(N::PlainSteps, whole),
        range(N::Evaluations, whole),
        tenths(of(N::PlainSteps, Summary::Mean) / of(N::Evaluations, Summary::Mean)),
        range(N::StoppedSteps, whole),
        range(N::StoppedDistance, percent),
        range(N::MissingEnergy, percent),
        power(of(N::PlainError, Summary::Most)),
        power(of(N::SolverError, Summary::Most)),
    ];
    Some((run.clone(), entries))
}

/// How many pulses there are, and how many have no stationary state.
fn settled(pulses: &[PulseRecord]) -> String {
    let settled = pulses.iter().filter(|p| p.number(PulseNumber::Settled) == 1.0).count();
    match pulses.len() - settled {
        0 => pulses.len().to_string(),
        caught => format!("{} ({caught} without end)", pulses.len()),
    }
}

fn gradient_columns(first: &str, second: &str) -> Vec<Column> {
    let of = |name: &str| [format!("Mean /\u{a0}(W/rad), {name}"), format!("Steps per pulse, {name}")];
    let [mean, steps] = of(first);
    let [other_mean, other_steps] = of(second);
    columns(&[
        "Field",
        &mean,
        &steps,
        &other_mean,
        &other_steps,
        "Mean lower by /\u{a0}%",
        "L2 difference /\u{a0}%",
    ])
}

fn gradient_row(row: &GradientRow, results: &Results) -> Option<Row> {
    let (first, second) = (results.gradients.get(&row.first)?, results.gradients.get(&row.second)?);
    let mean = |g: &LtgOutcome| g.volume.values().iter().sum::<f64>() / g.volume.values().len() as f64;
    let steps = |g: &LtgOutcome| g.work.iterations_total as f64 / g.work.sources as f64;
    let entries = vec![
        tenths(mean(first)),
        tenths(steps(first)),
        tenths(mean(second)),
        tenths(steps(second)),
        percent(1.0 - mean(first) / mean(second)),
        percent(gradient_difference(&second.volume, &first.volume).unwrap_or(f64::NAN)),
    ];
    Some((row.label.clone(), entries))
}

/// Ridges this near to each other, cells, meet.
const MEETING: f64 = 1.0;

fn comparison_columns() -> Vec<Column> {
    columns(&[
        "Field",
        "Correlation of FTLE with mean LTG",
        "with largest LTG",
        "FTLE ridges / cells long",
        "met by LTG ridges of some direction /\u{a0}%",
        "by chance /\u{a0}%",
        "their distance, mean / cells",
        "95\u{a0}% / cells",
        "LTG ridges of all directions / cells long",
        "met by FTLE ridges /\u{a0}%",
        "by chance /\u{a0}%",
        "their distance, mean / cells",
        "95\u{a0}% / cells",
        "Ridges of largest LTG met by FTLE ridges /\u{a0}%",
    ])
}

fn comparison_row(row: &ComparisonRow, results: &Results) -> Option<Row> {
    let ftle = MapSource::Ftle { run: row.ftle.clone() };
    let run = || row.gradient.clone();
    let correlation =
        |with| map_correlation(&ftle, &with, results).map_or_else(|| NOTHING.to_owned(), hundredths);
    let of_ftle = RidgeSource::Of(ftle.clone());
    let every = RidgeSource::EverySlice { run: run() };
    let forth = distances(&of_ftle, &every, results)?;
    let back = distances(&every, &of_ftle, results)?;
    let largest = distances(&RidgeSource::Of(MapSource::Maximum { run: run() }), &of_ftle, results)?;
    let mut entries =
        vec![correlation(MapSource::Mean { run: run() }), correlation(MapSource::Maximum { run: run() })];
    for (found, met) in [(&forth, &every), (&back, &of_ftle)] {
        entries.extend([
            whole(found.length()),
            percent(found.share_within(MEETING)),
            percent(chance_of(met, MEETING, results)?),
            tenths(found.mean()),
            tenths(found.quantile(0.95)),
        ]);
    }
    entries.push(percent(largest.share_within(MEETING)));
    Some((row.label.clone(), entries))
}

fn noise_columns() -> Vec<Column> {
    columns(&[
        "Field and noise",
        "FTLE: correlation with that without noise",
        "its ridges without noise still met /\u{a0}%",
        "its ridges with noise that were there before /\u{a0}%",
        "Largest LTG: correlation",
        "ridges still met /\u{a0}%",
        "ridges there before /\u{a0}%",
    ])
}

fn noise_row(row: &NoiseRow, results: &Results) -> Option<Row> {
    let ftle = |run: &String| MapSource::Ftle { run: run.clone() };
    let largest = |run: &String| MapSource::Maximum { run: run.clone() };
    let mut entries = Vec::new();
    for [clean, noisy] in
        [[ftle(&row.ftle.0), ftle(&row.ftle.1)], [largest(&row.gradient.0), largest(&row.gradient.1)]]
    {
        let correlation = map_correlation(&clean, &noisy, results);
        let (clean, noisy) = (RidgeSource::Of(clean), RidgeSource::Of(noisy));
        entries.extend([
            correlation.map_or_else(|| NOTHING.to_owned(), hundredths),
            percent(distances(&clean, &noisy, results)?.share_within(MEETING)),
            percent(distances(&noisy, &clean, results)?.share_within(MEETING)),
        ]);
    }
    Some((row.label.clone(), entries))
}

fn runtime_columns() -> Vec<Column> {
    let mut columns = columns(&[
        "Sweep",
        "Published: cores",
        "Published /\u{a0}s",
        "This run /\u{a0}s",
        "Times faster",
        "Remark",
    ]);
    if let Some(remark) = columns.last_mut() {
        remark.words = true;
    }
    columns
}

fn runtime_row(row: &RuntimeRow, results: &Results) -> Row {
    let taken = row.run.as_ref().map(|run| results.seconds.get(run).copied());
    let published_s = row.published_s.get();
    let (seconds_taken, faster) = match taken {
        Some(Some(s)) => (seconds(s), significant(published_s / s)),
        Some(None) => ("only with --full".to_owned(), NOTHING.to_owned()),
        None => ("no data".to_owned(), NOTHING.to_owned()),
    };
    (
        row.label.clone(),
        vec![row.cores.to_string(), seconds(published_s), seconds_taken, faster, row.remark.clone()],
    )
}

fn shown(x: f64, text: String) -> String {
    if x.is_finite() { text } else { NOTHING.to_owned() }
}

fn whole(x: f64) -> String {
    shown(x, format!("{x:.0}"))
}

fn tenths(x: f64) -> String {
    shown(x, format!("{x:.1}"))
}

fn hundredths(x: f64) -> String {
    shown(x, format!("{x:.2}"))
}

fn percent(share: f64) -> String {
    shown(share, format!("{:.1}", 100.0 * share))
}

/// One digit and the power of ten: all that is meant by an error.
fn power(x: f64) -> String {
    let text = format!("{x:.0e}");
    let raised = |c: char| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' | '3' => char::from(0xb0 + (c as u8 - b'0')),
        _ => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    match text.split_once('e') {
        Some((digit, exponent)) if x > 0.0 => {
            shown(x, format!("{digit} \u{d7} 10{}", exponent.chars().map(raised).collect::<String>()))
        }
        _ => whole(x),
    }
}

/// Seconds to three digits and more.
fn seconds(s: f64) -> String {
    let decimals = match s {
        ..10.0 => 2,
        ..100.0 => 1,
        _ => 0,
    };
    shown(s, grouped(&format!("{s:.decimals$}")))
}

/// Two significant digits.
fn significant(x: f64) -> String {
    let decimals = if x < 10.0 { 1 } else { 0 };
    shown(x, grouped(&format!("{x:.decimals$}")))
}

/// The digits before the decimal sign in groups of three.
fn grouped(number: &str) -> String {
    let end = number.find('.').unwrap_or(number.len());
    let mut out = String::new();
    for (i, c) in number.chars().enumerate() {
        if i > 0 && i < end && (end - i).is_multiple_of(3) {
            // Narrow no-break space: no reader takes it for a decimal sign.
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_for_readers() {
        assert_eq!((whole(812.4), tenths(7.25), percent(0.0815)), ("812".into(), "7.2".into(), "8.2".into()));
        assert_eq!((power(3.2e-10), power(0.0)), ("3 \u{d7} 10\u{207b}\u{b9}\u{2070}".into(), "0".into()));
        assert_eq!(power(5e-23), "5 \u{d7} 10\u{207b}\u{b2}\u{b3}");
        assert_eq!((seconds(179_878.0), seconds(0.4)), ("179\u{202f}878".into(), "0.40".into()));
        assert_eq!((significant(7.34), significant(1234.5)), ("7.3".into(), "1\u{202f}234".into()));
        assert_eq!((percent(f64::NAN), seconds(f64::INFINITY)), (NOTHING.into(), NOTHING.into()));
    }

    fn runtime(run: Option<&str>, results: &Results) -> Vec<String> {
        let published_s = spec::Positive::try_from(100.0).expect("above 0");
        let run = run.map(str::to_owned);
        let row = RuntimeRow { label: "a".into(), cores: 64, published_s, run, remark: String::new() };
        runtime_row(&row, results).1
    }

    #[test]
    fn a_runtime_says_why_it_is_missing() {
        let mut results = Results::default();
        results.seconds.insert("made".into(), 2.0);
        assert_eq!(runtime(Some("made"), &results)[..4], ["64", "100", "2.00", "50"]);
        assert_eq!(runtime(Some("left out"), &results)[2], "only with --full");
        assert_eq!(runtime(None, &results)[2], "no data");
    }
}
