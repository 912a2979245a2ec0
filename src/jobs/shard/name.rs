//! The names of a job's files.

/// The file of the job as a whole.
pub const JOB_FILE: &str = "job.json";

/// The file names of a job's folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// [`JOB_FILE`].
    Job,
    /// `shard-0001.json`.
    Shard(usize),
    /// `result-0001.json`.
    Result(usize),
    /// `result-0001.nodes`: what a shard of a paving found, and is finding.
    Nodes(usize),
    /// `result-0001.part`: a shard that runs, or was stopped.
    Progress(usize),
    /// `.orthocert-....part`: what a killed process left behind.
    Leftover,
    /// `engine`: the scripts and logs of [`crate::jobs::engine`].
    Engine,
}

impl Name {
    /// What a name in a job's folder stands for; `None` for foreign files.
    pub fn parse(name: &str) -> Option<Self> {
        let number = |prefix: &str, suffix: &str| {
            let digits = name.strip_prefix(prefix)?.strip_suffix(suffix)?;
            digits.parse().ok().filter(|n| *n > 0 && format!("{n:04}") == digits)
        };
        match name {
            JOB_FILE => return Some(Name::Job),
            "engine" => return Some(Name::Engine),
            _ if name.starts_with(".orthocert-") => return Some(Name::Leftover),
            _ => {}
        }
        let shard = number("shard-", ".json").map(Name::Shard);
        let result = || number("result-", ".json").map(Name::Result);
        let nodes = || number("result-", ".nodes").map(Name::Nodes);
        let progress = || number("result-", ".part").map(Name::Progress);
        shard.or_else(result).or_else(nodes).or_else(progress)
    }
}

/// The name of a file of a job's folder.
pub fn name_of(name: Name) -> String {
    match name {
        Name::Job => JOB_FILE.to_owned(),
        Name::Shard(n) => format!("shard-{n:04}.json"),
        Name::Result(n) => format!("result-{n:04}.json"),
        Name::Nodes(n) => format!("result-{n:04}.nodes"),
        Name::Progress(n) => format!("result-{n:04}.part"),
        Name::Leftover => ".orthocert-".to_owned(),
        Name::Engine => "engine".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_are_written() {
        let names =
            [Name::Job, Name::Shard(1), Name::Result(9999), Name::Nodes(3), Name::Progress(10_000)];
        for name in names {
            assert_eq!(Name::parse(&name_of(name)), Some(name));
        }
        for foreign in ["shard-1.json", "shard-0000.json", "result-00001.json", "a.txt", ""] {
            assert_eq!(Name::parse(foreign), None, "{foreign}");
        }
    }
}
