//! `review`: compares the results of two git revisions.

use crate::error::Fault;
use crate::interrupt;
use crate::revision::{self, Workshop};
use clap::Args;
use std::path::{Path, PathBuf};
use tigereye_report::review::{self, Results, Side};

/// What `reproduce` writes for programs.
const SUMMARY: &str = "summary.json";

#[derive(Debug, Args)]
pub(crate) struct ReviewArgs {
    /// The earlier results: a git revision, which is built and run, or a folder written by `tigereye reproduce --out`.
    base: String,
    /// The later results, likewise.
    head: String,
    /// Folder for the page and the summary, review.html and review.json.
    #[arg(long, value_name = "DIR", default_value = "review")]
    out: PathBuf,
    /// Only the experiment of this name, its file without folder and extension; repeatable. Only these are run for a
    /// revision.
    #[arg(long, value_name = "SLUG")]
    only: Vec<String>,
    /// Largest relative change at which a number still counts as unmoved.
    #[arg(long, value_name = "REL", default_value = "1e-9", value_parser = parse_tolerance, allow_hyphen_values = true)]
    tolerance: f64,
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("expected a finite number from 0".to_owned()),
    }
}

/// The exit code: 1 if something moved.
pub(crate) fn review(args: &ReviewArgs) -> Result<u8, Fault> {
    let names = [args.base.as_str(), args.head.as_str()];
    let mut workshop = Workshop::default();
    let sides = results_of(names, &args.only, &mut workshop)?;
    let read_side = |side: &Option<PathBuf>| match side {
        Some(folder) => Ok(results(folder)?.only(&args.only)),
        None => Ok::<_, Fault>(Results::default()),
    };
    let (base, head) = (read_side(&sides[0])?, read_side(&sides[1])?);
    let mut figure = |side, path: &str| {
        interrupt::check()?;
        let folder = &sides[usize::from(side == Side::Head)];
        let path = folder.as_deref().unwrap_or(Path::new("")).join(path);
        std::fs::read(&path).map_err(Fault::file(&path, "reading"))
    };
    let review = review::results(names, &base, &head, args.tolerance, &mut figure)?;
    interrupt::check()?;
    std::fs::create_dir_all(&args.out).map_err(Fault::file(&args.out, "making the folder"))?;
    let page = args.out.join("review.html");
    for (path, text) in
        [(args.out.join("review.json"), review::json(&review)), (page.clone(), review::html(&review))]
    {
        std::fs::write(&path, text).map_err(Fault::file(&path, "writing"))?;
    }
    println!("{}page: {}", review::text(&review), page.display());
    Ok(u8::from(review.moved()))
}

/// The source of one side's results.
enum Place {
    Folder(PathBuf),
    /// A revision by its commit.
    Revision(String),
}

impl Place {
    fn find(name: &str) -> Result<Self, Fault> {
        let folder = Path::new(name);
        if folder.join(SUMMARY).exists() {
            return Ok(Self::Folder(folder.to_path_buf()));
        }
        let commit = revision::commit(name)?;
        commit.map(Self::Revision).ok_or_else(|| Fault::Unknown { name: name.to_owned() })
    }

    /// The names of its experiments, found without building anything. A folder that cannot be read is a fault.
    fn slugs(&self) -> Result<Vec<String>, Fault> {
        match self {
            Self::Folder(folder) => Ok(results(folder)?.slugs().map(str::to_owned).collect()),
            Self::Revision(commit) => revision::slugs(commit),
        }
    }
}

/// The folders of both results; `None` for a side without any experiment of `only`, where there is nothing to run.
fn results_of(
    names: [&str; 2],
    only: &[String],
    workshop: &mut Workshop,
) -> Result<[Option<PathBuf>; 2], Fault> {
    // Both are looked for, and folders read, before anything is built.
    let places = [Place::find(names[0])?, Place::find(names[1])?];
    let slugs = [places[0].slugs()?, places[1].slugs()?];
    if let Some(slug) = only.iter().find(|only| !slugs.iter().any(|side| side.contains(only))) {
        let [base, head] = names.map(str::to_owned);
        return Err(Fault::NoExperiment { slug: slug.clone(), base, head });
    }
    let mut folders = [None, None];
    for (i, place) in places.into_iter().enumerate() {
        let wanted: Vec<String> = only.iter().filter(|slug| slugs[i].contains(slug)).cloned().collect();
        if !only.is_empty() && wanted.is_empty() {
            continue;
        }
        folders[i] = Some(match place {
            Place::Folder(folder) => folder,
            Place::Revision(commit) => workshop.results(names[i], &commit, &wanted)?,
        });
    }
    Ok(folders)
}

fn results(folder: &Path) -> Result<Results, Fault> {
    let path = folder.join(SUMMARY);
    let text = std::fs::read_to_string(&path).map_err(Fault::file(&path, "reading"))?;
    Ok(review::read(&path.display().to_string(), &text)?)
}
