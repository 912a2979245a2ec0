//! Running the binary in a folder of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A design that the search gives up on only when its budget is used up.
pub const LONG: &str = "long.toml";

/// A decimal, or a fraction, of an answer.
pub fn number(value: &serde_json::Value) -> f64 {
    let text = value.as_str().unwrap();
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    numerator.parse::<f64>().unwrap() / denominator.parse::<f64>().unwrap()
}

/// A folder in which the binary runs.
pub struct Folder(TempDir);

/// What a run left behind.
pub struct Run {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

fn tests() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

impl Folder {
    pub fn new() -> Self {
        Folder(tempfile::tempdir().unwrap())
    }

    /// A folder with these designs of the repository in it.
    pub fn with(names: &[&str]) -> Self {
        let folder = Folder::new();
        for name in names {
            let from = if *name == LONG { tests().join("cli") } else { tests().join("designs") };
            fs::copy(from.join(name), folder.path(name)).unwrap();
        }
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The names of everything in the folder, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command that runs the binary here, without a terminal.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_orthocert"));
        command.current_dir(self.0.path()).args(arguments).stdin(Stdio::null());
        command.env_remove("NO_COLOR");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Run {
        self.command(arguments).output().unwrap().into()
    }

    /// Runs the binary where no file can have another byte, as on a full disk.
    #[cfg(target_os = "linux")]
    pub fn run_on_a_full_disk(&self, arguments: &[&str]) -> Run {
        let shell = "trap '' XFSZ; ulimit -f 0; exec \"$0\" \"$@\"";
        let mut command = Command::new("sh");
        command.args(["-c", shell, env!("CARGO_BIN_EXE_orthocert")]).args(arguments);
        command.current_dir(self.0.path()).output().unwrap().into()
    }
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Run {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Run {
    /// Holds the exit code, and that nothing like a panic was said.
    pub fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "stdout: {}\nstderr: {}", self.stdout, self.stderr);
        for trace in ["panicked", "RUST_BACKTRACE", "stack backtrace", "defect of this program"] {
            assert!(!self.stderr.contains(trace), "{}", self.stderr);
        }
        self
    }

    /// Holds that the answer contains every one of these, wherever its lines break.
    pub fn says(self, parts: &[&str]) -> Self {
        let unbroken = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let answer = unbroken(&self.stdout);
        for part in parts {
            assert!(answer.contains(&unbroken(part)), "no {part:?} in\n{}", self.stdout);
        }
        self
    }

    /// Holds that the diagnostic contains every one of these, and that there is no answer.
    pub fn complains(self, parts: &[&str]) -> Self {
        assert_eq!(self.stdout, "");
        for part in parts {
            assert!(self.stderr.contains(part), "no {part:?} in\n{}", self.stderr);
        }
        self
    }
}
