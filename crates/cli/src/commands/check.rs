//! `tigereye check`: experiment files, parsed and validated.

use crate::args::experiments::CheckArgs;
use crate::commands::reproduce::{Prepared, Source, prepare};
use crate::commands::{counted, print_text};
use crate::error::CliError;
use crate::medium::read_scene;
use tigereye_experiments::scene::is_scene_file;

pub(crate) fn check(args: &CheckArgs) -> Result<u8, CliError> {
    let mut faults = Vec::new();
    for path in &args.files {
        let name = path.display().to_string();
        if is_scene_file(&name) {
            match read_scene(&name) {
                Ok((scene, _)) => {
                    let parts =
                        [counted(scene.scene.parts.len(), "part"), counted(scene.lights.len(), "light")];
                    let remarks: String = scene.remarks().iter().map(|r| format!("; {r}")).collect();
                    print_text(&format!("{name}: ok, {}{remarks}\n", parts.join(", ")))?;
                }
                Err(CliError::Inputs(found)) => faults.extend(found),
                Err(e) => faults.push(e.to_string()),
            }
            continue;
        }
        // The full run is the stricter one: every run, figure and check is looked at.
        match Source::from_file(path).and_then(|source| prepare(&source, true)) {
            Ok(Prepared::Lacks(file)) => {
                let words = format!("{}: valid, but it needs {file}, which is missing\n", path.display());
                print_text(&words)?;
            }
            Ok(Prepared::Ready(plan)) => {
                let parts = [
                    counted(plan.runs().count(), "run"),
                    counted(plan.figures().count(), "figure"),
                    counted(plan.checks().count(), "check"),
                ];
                print_text(&format!("{}: ok, {}\n", path.display(), parts.join(", ")))?;
            }
            Err(CliError::Inputs(found)) => faults.extend(found),
            Err(e) => faults.push(e.to_string()),
        }
    }
    if faults.is_empty() { Ok(0) } else { Err(CliError::Inputs(faults)) }
}
