//! `tigereye merge`: the gradient volume of shards computed apart.

use crate::args::light::MergeArgs;
use crate::commands::drawing;
use crate::commands::overlaid::Overlaid;
use crate::commands::propagate::check_outputs;
use crate::commands::volume::Look;
use crate::commands::{print_json, print_text, volume};
use crate::error::CliError;
use crate::medium::read_scene;
use crate::part_file::{self, Content, Costs, Identity, PartFile};
use crate::pieces::Pieces;
use crate::{files, interrupt};
use serde_json::json;
use std::path::{Path, PathBuf};
use tigereye_experiments::scene::{PreparedScene, is_scene_file};
use tigereye_ltg::Shard;
use tigereye_render::Colours;

/// Names listed in a message.
const LISTED: usize = 8;

/// What of a part is kept once its numbers are in the sum.
struct Taken {
    name: String,
    identity: Identity,
    shard: Shard,
    costs: Costs,
    done: Vec<bool>,
}

pub(crate) fn merge(args: &MergeArgs) -> Result<u8, CliError> {
    check_outputs(&args.outputs, &volume::EXTENSIONS)?;
    let style = drawing::style(&args.style, Colours::Values)?;
    let mut taken: Vec<Taken> = Vec::new();
    let mut sum = None;
    for path in &files_of(args)? {
        let (part, content) = match read(path) {
            Err(fault) if args.partial => {
                eprintln!("tigereye: left out: {fault}");
                continue;
            }
            read => read?,
        };
        if args.partial && taken.iter().any(|other| other.shard == part.shard) {
            // The checkpoint of a shard whose part is there.
            continue;
        }
        sum = Some(match sum {
            None => content,
            Some(sum) => added(sum, &taken, &part, &content)?,
        });
        taken.push(part);
        interrupt::check()?;
    }
    let Some(sum) = sum else { return Err(CliError::input("PART", "expected at least one part")) };
    if !args.partial {
        check_complete(&sum, &taken)?;
    }
    // The same provenance whatever the order on the command line.
    taken.sort_by_key(|part| part.shard.index());
    let mut identity = taken[0].identity.clone();
    let mut summary = sum.kept().summary(&identity, &costs(&taken));
    let (missing, total) = (sum.kept().missing(Shard::WHOLE), sum.kept().numbers().1.len());
    let unit = sum.kept().unit();
    let gradient = if args.partial { sum.into_partial_gradient() } else { sum.into_gradient() };
    let gradient = gradient.map_err(|e| CliError::input(&names(&taken), e))?;
    if args.partial {
        identity.parameters["missing"] = json!(format!("{missing} of {total} {unit}"));
        let known = || gradient.volume.values().iter().copied().filter(|v| !v.is_nan());
        summary["max"] = json!(known().fold(0.0, f64::max));
        summary["mean"] = json!(known().sum::<f64>() / known().count().max(1) as f64);
        summary["missing"] = json!(missing);
        summary["of"] = json!(total);
    }
    let drawn = args.outputs.iter().any(|output| drawing::is_picture(output));
    let scene = if drawn { scene_of(&identity, &args.outputs)? } else { None };
    let walls = scene.as_ref().map(|scene| &scene.layout.surfaces);
    let input = identity.parameters["input"].as_str().unwrap_or_default();
    let title = scene.as_ref().map_or(input, |scene| &scene.title);
    // Parts do not say which cells have no tensor.
    let overlaid = Overlaid::default();
    let look =
        Look { title, walls, masked: Vec::new(), style, unit: None, tensors: None, overlaid: &overlaid };
    volume::write(&args.outputs, &gradient, &look, &identity)?;
    if args.json {
        print_json(&summary)?
    } else {
        print_text(&volume::sentence(&summary, &identity.parameters["stop"]))?;
        if args.partial {
            print_text(&format!("{missing} of {total} {unit} are missing\n"))?
        }
    }
    Ok(0)
}

/// The files to merge: the parts, behind them for `--partial` the checkpoints.
fn files_of(args: &MergeArgs) -> Result<Vec<PathBuf>, CliError> {
    let pieces = Pieces::find(&args.parts)?;
    let mut files = pieces.parts;
    if args.partial {
        files.extend(pieces.checkpoints);
    } else if files.is_empty() {
        let problem =
            "has checkpoints, but no finished .part: expected every shard; --partial merges what is there";
        let name = args.parts.first().map(|path| path.display().to_string()).unwrap_or_default();
        return Err(CliError::input(&name, problem));
    }
    Ok(files)
}

/// The scene that the parts were made of, for its walls and title in pictures. Parts hold neither: where the file is
/// not the one that was read then, pictures go without, and standard error says so.
fn scene_of(identity: &Identity, outputs: &[PathBuf]) -> Result<Option<PreparedScene>, CliError> {
    let Some(name) = identity.parameters["input"].as_str().filter(|name| is_scene_file(name)) else {
        return Ok(None);
    };
    let lack = match read_scene(name) {
        Ok((scene, files)) if scene.blake3 == identity.input_blake3 => {
            files::check_apart(&files, outputs)?;
            return Ok(Some(scene));
        }
        Ok(_) => "has changed since the parts were made",
        Err(_) => "cannot be read here",
    };
    eprintln!("{name}: {lack}; the picture is without its walls");
    Ok(None)
}

fn read(path: &Path) -> Result<(Taken, Content), CliError> {
    let PartFile { identity, shard, costs, content } = part_file::read(path)?;
    if let Some(problem) = identity.foreign_version() {
        return Err(CliError::input(&path.display().to_string(), problem));
    }
    let done = content.kept().numbers().1.to_vec();
    Ok((Taken { name: path.display().to_string(), identity, shard, costs, done }, content))
}

/// The sum with a further part, which must belong to it.
fn added(sum: Content, taken: &[Taken], part: &Taken, content: &Content) -> Result<Content, CliError> {
    let first = &taken[0];
    if let Some((what, one, other)) = first.identity.difference(&part.identity) {
        let problem =
            format!("do not belong together: {what} is {one} and {other}; expected parts of one sweep");
        return Err(CliError::input(&format!("{} and {}", first.name, part.name), problem));
    }
    sum.merged(content).map_err(|error| {
        let overlaps = |other: &&Taken| other.done.iter().zip(&part.done).any(|(a, b)| *a && *b);
        let other = taken.iter().find(overlaps).unwrap_or(first);
        let problem =
            format!("{error}: expected every shard once, these are {} and {}", other.shard, part.shard);
        CliError::input(&format!("{} and {}", other.name, part.name), problem)
    })
}

/// Names what is missing.
fn check_complete(sum: &Content, taken: &[Taken]) -> Result<(), CliError> {
    let total = sum.kept().missing(Shard::WHOLE);
    if total == 0 {
        return Ok(());
    }
    for part in taken {
        let range = part.shard.range(part.done.len());
        let missing = sum.kept().missing(part.shard);
        if missing > 0 {
            let problem = format!(
                "shard {} is not finished: {missing} of {} {} are missing; expected a part that `ltg --shard` wrote",
                part.shard,
                range.len(),
                sum.kept().unit()
            );
            return Err(CliError::input(&part.name, problem));
        }
    }
    let count = taken[0].shard.count();
    let shards = sum.missing_shards(count);
    let listed: Vec<String> = shards.iter().take(LISTED).map(|i| format!("{i}/{count}")).collect();
    let more =
        if shards.len() > LISTED { format!(" and {} more", shards.len() - LISTED) } else { String::new() };
    let problem = format!("shard {}{more} is missing: expected all {count}", listed.join(", "));
    Err(CliError::input(&names(taken), problem))
}

fn names(taken: &[Taken]) -> String {
    let listed: Vec<&str> = taken.iter().take(LISTED).map(|part| part.name.as_str()).collect();
    let more =
        if taken.len() > LISTED { format!(" and {} more", taken.len() - LISTED) } else { String::new() };
    listed.join(", ") + &more
}

/// Seconds add up; memory and threads are those of the largest part.
fn costs(taken: &[Taken]) -> Costs {
    let sum = |of: fn(&Costs) -> f64| taken.iter().map(|part| of(&part.costs)).sum();
    let mut backends: Vec<&str> = taken.iter().map(|part| part.costs.backend.as_str()).collect();
    backends.sort_unstable();
    backends.dedup();
    Costs {
        total: sum(|c| c.total),
        propagation: sum(|c| c.propagation),
        difference: sum(|c| c.difference),
        peak_memory: taken.iter().filter_map(|part| part.costs.peak_memory).max(),
        threads: taken.iter().map(|part| part.costs.threads).max().unwrap_or(0),
        backend: backends.join(", "),
    }
}
