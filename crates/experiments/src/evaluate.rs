//! One experiment from its plan to its outcome.

use crate::digest::{Digest, digest};
use crate::error::ExperimentError;
use crate::figures::{Drawn, draw};
use crate::host::Host;
use crate::ids::RunId;
use crate::plan::{Plan, PlannedCheck, PlannedTable, file_name};
use crate::results::Results;
use crate::tables::NOTHING;
use rayon::prelude::*;
use tigereye_report::{CheckOutcome, DataFile, ExperimentOutcome, Table};

/// An outcome with the digest that snapshot tests compare.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Figures, checks, data; its `seconds` are 0 until the caller sets them.
    pub outcome: ExperimentOutcome,
    /// The numbers worth remembering.
    pub digest: Digest,
}

/// Runs an experiment, draws its figures and judges its checks. Gradients use at most `memory_bytes`.
///
/// # Errors
/// [`ExperimentError`]; a failed check is no error but part of the outcome.
pub fn evaluate(
    plan: &Plan,
    command: &str,
    memory_bytes: u64,
    host: &dyn Host,
) -> Result<Evaluation, ExperimentError> {
    let results = results(plan, memory_bytes, host)?;
    let drawn: Vec<Drawn> =
        plan.figures.par_iter().map(|figure| draw(figure, &plan.slug, &results)).collect::<Result<_, _>>()?;
    let mut data = data_files(plan, command, &results)?;
    let mut figures = Vec::new();
    for Drawn { figure, tables } in drawn {
        figures.push(figure);
        data.extend(tables);
    }
    let outcome = ExperimentOutcome {
        slug: plan.slug.clone(),
        title: plan.title.clone(),
        source: plan.source.clone(),
        section: plan.section.clone(),
        claim: plan.claim.clone(),
        look_for: plan.look_for.clone(),
        figures,
        tables: plan.tables.iter().map(|t| table(t, &results)).collect(),
        checks: plan.checks.iter().map(|c| judged(c, &results)).collect(),
        work: work_of(plan, &results),
        data,
        seconds: 0.0,
        command: command.to_owned(),
    };
    let digest = digest(plan, &results, &outcome);
    Ok(Evaluation { outcome, digest })
}

/// Makes all runs, one after the other.
fn results<'a>(plan: &'a Plan, memory_bytes: u64, host: &dyn Host) -> Result<Results<'a>, ExperimentError> {
    let mut results = Results::new(&plan.media);
    for run in &plan.runs {
        let start = host.seconds();
        let outcome = match &run.plan {
            None => None,
            Some(made) => {
                let failed = |source| ExperimentError::Run { slug: plan.slug.clone(), source };
                let outcome = made.run(&run.name, &plan.media, memory_bytes, host).map_err(failed)?;
                Some((outcome, host.seconds() - start))
            }
        };
        results.push(outcome);
    }
    Ok(results)
}

/// A check with its value. What cannot be measured is not a number, fails, and says why.
fn judged(check: &PlannedCheck, results: &Results<'_>) -> CheckOutcome {
    let measured = (check.measure)(results);
    let value = *measured.as_ref().unwrap_or(&f64::NAN);
    CheckOutcome {
        name: check.name.clone(),
        value,
        expected: check.expected,
        basis: check.basis.clone(),
        passed: check.expected.is_met_by(value),
        reason: measured.err().map(|e| e.to_string()),
    }
}

fn table(table: &PlannedTable, results: &Results<'_>) -> Table {
    let entries = table.columns.len().saturating_sub(1);
    let row = |(i, row): (usize, &crate::tables::PlannedRow)| {
        row(results).unwrap_or_else(|why| {
            let mut all = vec![NOTHING.to_owned(); entries];
            if let Some(first) = all.first_mut() {
                *first = why.to_string();
            }
            (format!("row {}", i + 1), all)
        })
    };
    Table {
        title: table.title.clone(),
        caption: table.caption.clone(),
        columns: table.columns.clone(),
        rows: table.rows.iter().enumerate().map(row).collect(),
    }
}

fn work_of(plan: &Plan, results: &Results<'_>) -> Vec<(String, u64)> {
    let of_run = |(i, run): (usize, &crate::plan::PlannedRun)| {
        let work = results.outcome(RunId(i)).map(crate::runs::RunOutcome::work).unwrap_or_default();
        work.into_iter().map(|(what, n)| (format!("{}: {what}", run.name), n)).collect::<Vec<_>>()
    };
    plan.runs.iter().enumerate().flat_map(of_run).collect()
}

/// Every run's result with its provenance, except where the file wants none.
fn data_files(plan: &Plan, command: &str, results: &Results<'_>) -> Result<Vec<DataFile>, ExperimentError> {
    let mut files = Vec::new();
    for (i, run) in plan.runs.iter().enumerate() {
        let (Some(outcome), Some(made)) = (results.outcome(RunId(i)), &run.plan) else { continue };
        if !run.is_written {
            continue;
        }
        let encoded = outcome.data(made, &file_name(&run.name), command, &plan.media);
        let failed = |source| ExperimentError::Encoding {
            slug: plan.slug.clone(),
            run: run.name.clone(),
            source: Box::new(source),
        };
        files.extend(encoded.transpose().map_err(failed)?);
    }
    Ok(files)
}
