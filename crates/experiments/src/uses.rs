//! Which runs and fields the figures, tables and checks of an experiment mention.

use crate::spec::{
    Experiment, MapSource, Panel, ProfileSource, Quantity, RidgeSource, Run, SeriesSource, Table, TableRows,
};

/// The kinds of runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RunKind {
    Light,
    Gradient,
    Pulses,
    Ftle,
}

impl RunKind {
    pub(crate) const fn of(run: &Run) -> Self {
        match run {
            Run::Light { .. } => Self::Light,
            Run::Gradient { .. } => Self::Gradient,
            Run::Pulses { .. } => Self::Pulses,
            Run::Ftle { .. } => Self::Ftle,
        }
    }
}

/// Runs a panel shows.
pub(crate) fn of_panel(panel: &Panel) -> Vec<(&str, RunKind)> {
    match panel {
        Panel::Glyphs { .. } | Panel::Orientation { .. } | Panel::Lines { .. } | Panel::Texture { .. } => {
            Vec::new()
        }
        Panel::Map { map, .. } => vec![of_map(map)],
        Panel::Ridges { sources, .. } => sources.iter().map(|(_, source)| of_ridges(source)).collect(),
        Panel::Overlay { run, .. } | Panel::Energy { run, .. } => vec![(run, RunKind::Light)],
        Panel::Slice { run, .. } | Panel::Flat { run, .. } => vec![(run, RunKind::Gradient)],
        Panel::Polar { curves, .. } => curves
            .iter()
            .filter_map(|c| match &c.source {
                ProfileSource::Light { run, .. } | ProfileSource::Windowed { run, .. } => {
                    Some((run.as_str(), RunKind::Light))
                }
                _ => None,
            })
            .collect(),
        Panel::Chart { series, .. } => series.iter().filter_map(of_series).collect(),
    }
}

fn of_map(map: &MapSource) -> (&str, RunKind) {
    let kind = if matches!(map, MapSource::Ftle { .. }) { RunKind::Ftle } else { RunKind::Gradient };
    (map.run(), kind)
}

fn of_ridges(source: &RidgeSource) -> (&str, RunKind) {
    match source {
        RidgeSource::Of(map) => of_map(map),
        RidgeSource::EverySlice { run } => (run, RunKind::Gradient),
    }
}

fn of_series(series: &SeriesSource) -> Option<(&str, RunKind)> {
    use SeriesSource as S;
    match series {
        // Runs of another scope only leave points out.
        S::Points { .. } | S::Formula { .. } | S::Seconds { .. } => None,
        S::Deviation { of, .. } => of_series(of),
        S::NetFlux { run, .. }
        | S::OutwardLobe { run, .. }
        | S::EnergyError { run, .. }
        | S::RadiusMean { run, .. }
        | S::RadiusSpread { run, .. } => Some((run, RunKind::Light)),
        S::SliceRow { run, .. } | S::MeanOverCells { run, .. } => Some((run, RunKind::Gradient)),
        S::PulsesOverColumn { run, .. } => Some((run, RunKind::Pulses)),
    }
}

/// Runs a table shows whose kind matters.
pub(crate) fn of_table(table: &Table) -> Vec<(&str, RunKind)> {
    match &table.rows {
        TableRows::Pulses { runs } => runs.iter().map(|r| (r.as_str(), RunKind::Pulses)).collect(),
        TableRows::Gradients { rows, .. } => {
            rows.iter().flat_map(|r| [&r.first, &r.second]).map(|r| (r.as_str(), RunKind::Gradient)).collect()
        }
        TableRows::Comparison { rows } => rows
            .iter()
            .flat_map(|r| [(r.ftle.as_str(), RunKind::Ftle), (r.gradient.as_str(), RunKind::Gradient)])
            .collect(),
        TableRows::Noise { rows } => rows
            .iter()
            .flat_map(|r| {
                let ftle = [&r.ftle.0, &r.ftle.1].map(|run| (run.as_str(), RunKind::Ftle));
                let gradient = [&r.gradient.0, &r.gradient.1].map(|run| (run.as_str(), RunKind::Gradient));
                ftle.into_iter().chain(gradient)
            })
            .collect(),
        TableRows::Runtimes { .. } => Vec::new(),
    }
}

/// Leaves rows out whose runs are not among `runs`; a runtime that is missing is told instead.
pub(crate) fn keep_rows(table: &mut Table, runs: &[&str]) {
    match &mut table.rows {
        TableRows::Pulses { runs: rows } => rows.retain(|r| runs.contains(&r.as_str())),
        TableRows::Gradients { rows, .. } => {
            rows.retain(|r| runs.contains(&r.first.as_str()) && runs.contains(&r.second.as_str()));
        }
        TableRows::Comparison { rows } => {
            rows.retain(|r| [&r.ftle, &r.gradient].iter().all(|run| runs.contains(&run.as_str())));
        }
        TableRows::Noise { rows } => {
            rows.retain(|r| {
                let all = [&r.ftle.0, &r.ftle.1, &r.gradient.0, &r.gradient.1];
                all.iter().all(|run| runs.contains(&run.as_str()))
            });
        }
        TableRows::Runtimes { .. } => {}
    }
}

/// Whether a table has no rows.
pub(crate) const fn is_empty(table: &Table) -> bool {
    match &table.rows {
        TableRows::Pulses { runs } => runs.is_empty(),
        TableRows::Gradients { rows, .. } => rows.is_empty(),
        TableRows::Comparison { rows } => rows.is_empty(),
        TableRows::Noise { rows } => rows.is_empty(),
        TableRows::Runtimes { rows } => rows.is_empty(),
    }
}

/// Fields a panel shows.
pub(crate) fn fields_of_panel(panel: &Panel) -> Vec<&str> {
    match panel {
        Panel::Glyphs { field, .. }
        | Panel::Orientation { field, .. }
        | Panel::Lines { field, .. }
        | Panel::Texture { field, .. }
        | Panel::Ridges { field, .. } => vec![field],
        Panel::Polar { curves, .. } => curves
            .iter()
            .filter_map(|c| match &c.source {
                ProfileSource::Ellipse { field, .. } => Some(field.as_str()),
                _ => None,
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Runs a quantity is measured on.
pub(crate) fn of_quantity(quantity: &Quantity) -> Vec<(&str, RunKind)> {
    use Quantity as Q;
    match quantity {
        Q::Scheme(_)
        | Q::EmitterFlux(_)
        | Q::DeterminantError { .. }
        | Q::MajorAxisDeg { .. }
        | Q::MajorAxisError { .. }
        | Q::IsotropicShare { .. }
        | Q::ZeroShare { .. }
        | Q::TotalAnisotropyShare { .. }
        | Q::ComplexShare { .. }
        | Q::LargestAxis { .. } => Vec::new(),
        Q::Steps { run }
        | Q::Stopped { run }
        | Q::TotalEnergy { run }
        | Q::EnergyDrift { run }
        | Q::NetFluxRatio { run, .. }
        | Q::LobeRatio { run, .. }
        | Q::EnergyRatio { run, .. }
        | Q::WayLength { run, .. }
        | Q::WayExcess { run, .. }
        | Q::WayDifference { run, .. }
        | Q::ShortestWays { run }
        | Q::RingShare { run, .. }
        | Q::BoxShare { run, .. }
        | Q::LightSymmetry { run, .. }
        | Q::RadiusMean { run, .. }
        | Q::RadiusSpread { run, .. }
        | Q::FrontRoundness { run, .. } => vec![(run, RunKind::Light)],
        Q::EnergyOver { run, over, .. } => vec![(run, RunKind::Light), (over, RunKind::Light)],
        Q::LightDifference { run, from } => vec![(run, RunKind::Light), (from, RunKind::Light)],
        Q::GradientAt { run, .. }
        | Q::GradientRatio { run, .. }
        | Q::GradientMax { run }
        | Q::GradientMean { run }
        | Q::GradientLimited { run }
        | Q::RidgeColumnError { run, .. }
        | Q::RidgeContrast { run, .. }
        | Q::GradientSymmetry { run, .. } => vec![(run, RunKind::Gradient)],
        Q::GradientCorrelation { run, with: other } | Q::GradientDifference { run, from: other } => {
            vec![(run, RunKind::Gradient), (other, RunKind::Gradient)]
        }
        Q::MapCorrelation { map, with } => vec![of_map(map), of_map(with)],
        Q::RidgeDistance { of, from, .. } => vec![of_ridges(of), of_ridges(from)],
        Q::OfPulses { runs, .. } => runs.iter().map(|r| (r.as_str(), RunKind::Pulses)).collect(),
    }
}

/// The field a quantity is measured on.
pub(crate) fn field_of_quantity(quantity: &Quantity) -> Option<&str> {
    use Quantity as Q;
    match quantity {
        Q::DeterminantError { field }
        | Q::MajorAxisDeg { field, .. }
        | Q::MajorAxisError { field, .. }
        | Q::IsotropicShare { field }
        | Q::ZeroShare { field }
        | Q::TotalAnisotropyShare { field }
        | Q::ComplexShare { field }
        | Q::LargestAxis { field } => Some(field),
        _ => None,
    }
}

/// Every how many steps a run's energies are kept for an animation.
pub(crate) fn wants_reel(experiment: &Experiment, run: &str) -> Option<usize> {
    let animations = experiment.figures.iter().filter_map(|f| f.animation.as_ref());
    let every = animations.filter(|a| a.run == run).map(|a| a.every.get());
    // So often that every animation finds its frames.
    every.reduce(common_divisor)
}

fn common_divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Whether anything asks for the radius of the energy of `run` at every step.
pub(crate) fn wants_radius(experiment: &Experiment, run: &str) -> bool {
    let in_check = experiment.checks.iter().any(|c| {
        matches!(&c.quantity, Quantity::RadiusMean { run: r, .. } | Quantity::RadiusSpread { run: r, .. } if r == run)
    });
    let wants = |s: &SeriesSource| matches!(s, SeriesSource::RadiusMean { run: r, .. } | SeriesSource::RadiusSpread { run: r, .. } if r == run);
    let mut panels = experiment.figures.iter().flat_map(|f| &f.panels);
    in_check || panels.any(|p| matches!(p, Panel::Chart { series, .. } if series.iter().any(wants)))
}
