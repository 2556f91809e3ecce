//! `tigereye status`: how far the shards of a sweep are.

use crate::args::light::StatusArgs;
use crate::commands::{counted, print_json, print_text};
use crate::error::CliError;
use crate::interrupt;
use crate::part_file::{self, Identity, PartFile};
use crate::pieces::{self, Pieces};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::time::SystemTime;

/// Shards listed one by one.
const LISTED: usize = 32;

/// What is there of a shard.
struct Row {
    name: String,
    done: usize,
    total: usize,
    /// Seconds spent on it, of all its runs.
    seconds: f64,
    /// Seconds since the file was written.
    age: Option<f64>,
}

impl Row {
    const fn is_done(&self) -> bool {
        self.done == self.total
    }
    /// Seconds that the rest takes at the rate so far; nothing before anything is done.
    fn left(&self) -> Option<f64> {
        let rest = (self.total - self.done) as f64;
        (self.done > 0).then(|| self.seconds / self.done as f64 * rest)
    }
}

/// All that was found.
#[derive(Default)]
struct Status {
    identity: Option<Identity>,
    count: usize,
    rows: BTreeMap<usize, Row>,
    broken: Vec<(String, String)>,
    failed: Vec<(String, String)>,
}

pub(crate) fn status(args: &StatusArgs) -> Result<u8, CliError> {
    let pieces = Pieces::find(&args.paths)?;
    let mut status = Status::default();
    for path in pieces.parts.iter().chain(&pieces.checkpoints) {
        status.take(path);
        interrupt::check()?;
    }
    for path in &pieces.failed {
        status.failed.push((path.display().to_string(), pieces::message(path)?));
    }
    if args.json {
        print_json(&status.json())?
    } else {
        print_text(&status.text())?
    }
    Ok(u8::from(!status.is_complete()))
}

impl Status {
    fn take(&mut self, path: &Path) {
        let name = path.display().to_string();
        match part_file::read(path) {
            Err(problem) => {
                let problem = problem.to_string();
                let problem = problem.strip_prefix(&format!("{name}: ")).unwrap_or(&problem).to_owned();
                self.broken.push((name, problem));
            }
            Ok(part) => {
                if let Err(problem) = self.add(&name, path, part) {
                    self.broken.push((name, problem));
                }
            }
        }
    }

    /// Takes a part that belongs to the sweep of the first one; otherwise says why it does not.
    fn add(&mut self, name: &str, path: &Path, part: PartFile) -> Result<(), String> {
        let PartFile { identity, shard, costs, content } = part;
        if let Some(problem) = identity.foreign_version() {
            return Err(problem);
        }
        match &self.identity {
            None => (self.identity, self.count) = (Some(identity), shard.count()),
            Some(first) => {
                if let Some((what, one, other)) = first.difference(&identity) {
                    return Err(format!(
                        "belongs to another sweep: {what} is {other} there and {one} in the first part"
                    ));
                }
                if shard.count() != self.count {
                    return Err(format!(
                        "shard {shard} beside shards of {}: expected one division",
                        self.count
                    ));
                }
            }
        }
        let kept = content.kept();
        let total = shard.range(kept.numbers().1.len()).len();
        let written = path.metadata().and_then(|m| m.modified()).ok();
        let age = written.and_then(|at| SystemTime::now().duration_since(at).ok());
        let row = Row {
            name: name.to_owned(),
            done: total - kept.missing(shard),
            total,
            seconds: costs.total,
            age: age.map(|age| age.as_secs_f64()),
        };
        let further = self.rows.get(&shard.index()).is_none_or(|known| row.done > known.done);
        if further {
            self.rows.insert(shard.index(), row);
        }
        Ok(())
    }

    fn missing(&self) -> Vec<usize> {
        (0..self.count).filter(|index| !self.rows.contains_key(index)).take(LISTED).collect()
    }
    fn missing_count(&self) -> usize {
        self.count - self.rows.len()
    }
    fn done_count(&self) -> usize {
        self.rows.values().filter(|row| row.is_done()).count()
    }
    fn is_complete(&self) -> bool {
        self.count > 0 && self.done_count() == self.count
    }
    /// The share of all shards that is done; shards are of nearly equal size.
    fn share(&self) -> f64 {
        let share = |row: &Row| if row.total == 0 { 1.0 } else { row.done as f64 / row.total as f64 };
        self.rows.values().map(share).sum::<f64>() / self.count.max(1) as f64
    }
    /// Seconds until the last of the shards that have begun ends, if all run now.
    fn left(&self) -> Option<f64> {
        let open = self.rows.values().filter(|row| !row.is_done());
        open.map(Row::left).try_fold(0.0, |longest: f64, left| Some(longest.max(left?)))
    }
    /// Seconds that a shard that is missing will take: as long as the longest of the others.
    fn whole(&self) -> Option<f64> {
        self.rows
            .values()
            .map(|row| Some(row.seconds + row.left()?))
            .try_fold(0.0, |m: f64, s| Some(m.max(s?)))
    }

    fn json(&self) -> Value {
        let row = |(index, row): (&usize, &Row)| {
            json!({
                "shard": format!("{index}/{}", self.count),
                "file": row.name,
                "state": if row.is_done() { "done" } else { "begun" },
                "done": row.done,
                "total": row.total,
                "seconds": row.seconds,
                "seconds_left": row.left(),
                "written_seconds_ago": row.age,
            })
        };
        let faults = |list: &[(String, String)]| -> Vec<Value> {
            list.iter().map(|(file, problem)| json!({ "file": file, "problem": problem })).collect()
        };
        let missing: Vec<usize> = (0..self.count).filter(|i| !self.rows.contains_key(i)).collect();
        json!({
            "shards": self.count,
            "complete": self.is_complete(),
            "share": self.share(),
            "seconds_left": self.left(),
            "parts": self.rows.iter().map(row).collect::<Vec<_>>(),
            "missing": missing,
            "broken": faults(&self.broken),
            "failed": faults(&self.failed),
        })
    }

    fn text(&self) -> String {
        let begun = self.rows.len() - self.done_count();
        let mut text = format!(
            "{}: {} done, {begun} begun, {} missing, {} broken, {} failed; {:.1} % of the sweep\n",
            counted(self.count, "shard"),
            self.done_count(),
            self.missing_count(),
            self.broken.len(),
            self.failed.len(),
            100.0 * self.share(),
        );
        // Writing to a text cannot fail.
        let open: Vec<_> = self.rows.iter().filter(|(_, row)| !row.is_done()).collect();
        for (index, row) in open.iter().take(LISTED) {
            let left = row.left().map_or_else(
                || "time left not known yet".to_owned(),
                |s| format!("about {} left", lasting(s)),
            );
            let age = row.age.map(|s| format!(", written {} ago", lasting(s))).unwrap_or_default();
            let share = 100.0 * row.done as f64 / row.total.max(1) as f64;
            let _ = writeln!(text, "  {index}/{}: {share:.1} %, {left}{age} ({})", self.count, row.name);
        }
        if open.len() > LISTED {
            let _ = writeln!(text, "  and {} more", open.len() - LISTED);
        }
        let missing = self.missing();
        if !missing.is_empty() {
            let names: Vec<String> = missing.iter().map(|index| format!("{index}/{}", self.count)).collect();
            let more = self.missing_count() - missing.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let takes =
                self.whole().map(|s| format!("; each takes about {}", lasting(s))).unwrap_or_default();
            let _ = writeln!(text, "  missing: {}{more}{takes}", names.join(", "));
        }
        for (file, problem) in &self.broken {
            let _ = writeln!(text, "  broken: {file}: {problem}");
        }
        for (file, problem) in &self.failed {
            let _ = writeln!(text, "  failed: {file}: {}", problem.replace('\n', " "));
        }
        if self.is_complete() {
            text.push_str("  complete: `tigereye merge` makes the volume\n");
        } else if let Some(left) = self.left().filter(|_| begun > 0) {
            let _ = writeln!(text, "  those begun end in about {} if all of them run", lasting(left));
        }
        text
    }
}

/// A duration as people say it.
pub(crate) fn lasting(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s if s < 2.0 * 86_400.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

#[cfg(test)]
mod tests {
    use super::lasting;

    #[test]
    fn durations_are_said_as_people_do() {
        let said = [0.4, 59.0, 600.0, 7200.0, 259_200.0].map(lasting);
        assert_eq!(said, ["0 s", "59 s", "10 min", "2.0 h", "3.0 days"]);
    }
}
