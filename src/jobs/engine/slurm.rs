//! Slurm: `sbatch` with a job array, and a merge that depends on it.

use super::{answer_of, folder, quoted, EngineError, Script, Submission, Submitted};
use std::process::Command;

const HELP: &str = "sbatch comes with Slurm (Debian: slurm-client), on the cluster's login nodes";

/// Times that a task goes back to the queue.
const RESTARTS: u32 = 10;

pub(super) fn scripts(submission: &Submission) -> Vec<Script> {
    let (job, shards) = (&submission.job, submission.shards);
    let engine = folder(&submission.folder);
    // A percent sign begins a pattern in Slurm's file names.
    let logs = engine.to_string_lossy().into_owned().replace('%', "%%");
    let array = format!(
        "#!/bin/bash\n\
         # The shards of orthocert job {job}: a task of this array for each. It can be submitted\n\
         # again at any time: shards that are done do nothing.\n\
         #SBATCH --job-name=orthocert-{job:.8}\n\
         #SBATCH --array=1-{shards}\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --cpus-per-task=1\n\
         # A task whose node is lost goes back to the queue.\n\
         #SBATCH --requeue\n\
         #SBATCH --open-mode=append\n\
         #SBATCH --output=\"{logs}/%a.log\"\n\
         set -u\n\
         bash {task} \"$SLURM_ARRAY_TASK_ID\"\n\
         code=$?\n\
         # So does one that failed for a reason that may pass.\n\
         if [ $code -ne 0 ] && [ $code -ne 2 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {RESTARTS} ]; then\n\
         \x20 scontrol requeue \"$SLURM_JOB_ID\" && sleep 60\n\
         fi\n\
         exit $code\n",
        task = quoted(&engine.join("task.sh"))
    );
    let merge = format!(
        "#!/bin/bash\n\
         # Puts the results of orthocert job {job} together, after all of its shards.\n\
         #SBATCH --job-name=orthocert-merge-{job:.8}\n\
         #SBATCH --ntasks=1\n\
         # The exact check of maps and pavings goes over as many cores as there are here.\n\
         #SBATCH --cpus-per-task=1\n\
         #SBATCH --requeue\n\
         #SBATCH --open-mode=append\n\
         #SBATCH --output=\"{logs}/merge.log\"\n\
         exec {program} merge {folder} --output {result} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" --quiet\n",
        program = quoted(&submission.program),
        folder = quoted(&submission.folder),
        result = quoted(&submission.result)
    );
    vec![("array.sbatch", array), ("merge.sbatch", merge)]
}

pub(super) fn submit(submission: &Submission) -> Result<Submitted, EngineError> {
    let engine = folder(&submission.folder);
    let sbatch = |script: &str, after: Option<&str>| {
        let mut command = Command::new("sbatch");
        command.arg("--parsable").args(&submission.options);
        if let Some(job) = after {
            command.arg(format!("--dependency=afterok:{job}")).arg("--kill-on-invalid-dep=yes");
        }
        answer_of(command.arg(engine.join(script)), "sbatch", HELP)
            // The number may be followed by the cluster's name.
            .map(|answer| answer.split(';').next().unwrap_or_default().to_owned())
    };
    let shards = sbatch("array.sbatch", None)?;
    let merge = sbatch("merge.sbatch", Some(&shards)).map_err(|error| match error {
        EngineError::Refused(command, words) => EngineError::Refused(
            command,
            format!("{words} (the shards are job {shards}; only the merge was refused)"),
        ),
        other => other,
    })?;
    Ok(Submitted { shards, merge })
}
