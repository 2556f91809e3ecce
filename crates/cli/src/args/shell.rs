//! Options of `completions` and `man`.

use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

/// Options of `tigereye completions`.
#[derive(Debug, Args)]
#[command(
    after_help = "bash: tigereye completions bash > ~/.local/share/bash-completion/completions/tigereye\n\
                        zsh:  tigereye completions zsh > ~/.zfunc/_tigereye, with ~/.zfunc in fpath\n\
                        fish: tigereye completions fish > ~/.config/fish/completions/tigereye.fish"
)]
pub(crate) struct CompletionsArgs {
    /// The shell that reads the script.
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

/// Options of `tigereye man`.
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Folder for the pages, such as `~/.local/share/man/man1`; it is made where it is missing.
    #[arg(long, value_name = "FOLDER")]
    pub(crate) out: PathBuf,
}
