//! `tigereye review`: what a change moved, as a page, as JSON and as a few lines.

use crate::args::experiments::ReviewArgs;
use crate::commands::print_text;
use crate::error::CliError;
use crate::{files, interrupt};
use std::path::Path;
use tigereye_report::review::{self, MAX_FILE, Pending, Results, Review, Side};

/// What `reproduce` writes for programs.
const SUMMARY: &str = "summary.json";

/// The ending of a snapshot that waits to be accepted.
const PENDING: &str = ".snap.new";

/// The ending of an accepted one.
const ACCEPTED: &str = ".snap";

pub(crate) fn review(args: &ReviewArgs) -> Result<u8, CliError> {
    let review = match (&args.snapshots, &args.base, &args.head) {
        (Some(folder), ..) => of_snapshots(folder, args.tolerance)?,
        (None, Some(base), Some(head)) => of_results([base, head], &args.only, args.tolerance)?,
        _ => return Err(CliError::Input("expected BASE and HEAD, or --snapshots".to_owned())),
    };
    interrupt::check()?;
    let (page, summary) = (review::html(&review), review::json(&review));
    files::make_folder(&args.out)?;
    files::write(&args.out.join("review.json"), summary.as_bytes())?;
    let path = args.out.join("review.html");
    files::write(&path, page.as_bytes())?;
    print_text(&format!("{}page: {}\n", review::text(&review), path.display()))?;
    Ok(u8::from(review.moved()))
}

fn of_results(folders: [&Path; 2], only: &[String], tolerance: f64) -> Result<Review, CliError> {
    let names = folders.map(|folder| folder.display().to_string());
    let (base, head) = (results(folders[0])?, results(folders[1])?);
    if let Some(unknown) = only.iter().find(|only| !base.slugs().chain(head.slugs()).any(|s| s == **only)) {
        let [base, head] = names;
        return Err(CliError::Input(format!("--only {unknown}: no such experiment in {base} or {head}")));
    }
    let mut figure = |side, path: &str| {
        interrupt::check()?;
        read(&folders[usize::from(side == Side::Head)].join(path))
    };
    let (base, head) = (base.only(only), head.only(only));
    review::results(names.each_ref().map(String::as_str), &base, &head, tolerance, &mut figure)
}

fn results(folder: &Path) -> Result<Results, CliError> {
    let path = folder.join(SUMMARY);
    if !path.exists() {
        let problem =
            format!("there is no {}: expected a folder of results, as `reproduce` writes it", path.display());
        return Err(CliError::input(&folder.display().to_string(), problem));
    }
    let text = files::text_of(&path, read(&path)?)?;
    Ok(review::read(&path.display().to_string(), &text)?)
}

/// A file of results: nothing else is opened, a pipe least of all.
fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    let fault = |source| CliError::File { path: path.display().to_string(), action: "reading", source };
    if !std::fs::metadata(path).map_err(fault)?.is_file() {
        return Err(CliError::input(&path.display().to_string(), "expected a file"));
    }
    files::read_at_most(path, MAX_FILE)
}

fn of_snapshots(folder: &Path, tolerance: f64) -> Result<Review, CliError> {
    let fault = |source| CliError::File { path: folder.display().to_string(), action: "listing", source };
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(fault)? {
        // Names that are not UTF-8 are not snapshots.
        names.extend(entry.map_err(fault)?.file_name().into_string());
    }
    names.sort();
    let text = |name: &str| {
        let path = folder.join(name);
        files::text_of(&path, read(&path)?)
    };
    let mut pending = Vec::new();
    for name in names.iter().filter_map(|n| n.strip_suffix(PENDING)) {
        let accepted = format!("{name}{ACCEPTED}");
        let accepted = names.contains(&accepted).then(|| text(&accepted)).transpose()?;
        let new = text(&format!("{name}{PENDING}"))?;
        pending.push(Pending { name: name.to_owned(), accepted, pending: new });
    }
    let accepted = names.iter().filter(|n| n.ends_with(ACCEPTED)).count();
    let replaced = pending.iter().filter(|p| p.accepted.is_some()).count();
    let sides = [ACCEPTED, PENDING].map(|ending| folder.join(format!("*{ending}")).display().to_string());
    let sides = [sides[0].as_str(), sides[1].as_str()];
    Ok(review::snapshots(sides, &pending, accepted - replaced, tolerance))
}
