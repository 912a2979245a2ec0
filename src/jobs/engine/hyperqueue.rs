//! HyperQueue, through its Python package: a job with a task for each shard, and one that depends on
//! all of them.

use super::{answer_of, folder, EngineError, Script, Submission, Submitted};
use std::path::Path;
use std::process::Command;

const PYTHON: &str = "python3";
const HELP: &str = "the script needs Python 3 with the package hyperqueue (pip install hyperqueue)";

pub(super) fn scripts(submission: &Submission) -> Vec<Script> {
    let engine = folder(&submission.folder);
    let text = |path: &Path| {
        serde_json::to_string(&path.to_string_lossy().into_owned()).unwrap_or_default()
    };
    let script = format!(
        "# Submits the shards of orthocert job {job} to HyperQueue, and prints the job's number. The\n\
         # server is the one whose folder HQ_SERVER_DIR names, or the default one. It can be submitted\n\
         # again at any time: shards that are done do nothing.\n\
         import os\n\
         import sys\n\
         \n\
         try:\n\
         \x20   from hyperqueue import Client, Job\n\
         except ImportError:\n\
         \x20   sys.exit(\"{HELP}\")\n\
         \n\
         engine = {engine}\n\
         job = Job(name=\"orthocert-{job:.8}\", max_fails=None)\n\
         shards = [\n\
         \x20   job.program(\n\
         \x20       [\"bash\", engine + \"/task.sh\", str(number)],\n\
         \x20       stdout=f\"{{engine}}/{{number}}.log\",\n\
         \x20       stderr=f\"{{engine}}/{{number}}.err\",\n\
         \x20       crash_limit=100,\n\
         \x20   )\n\
         \x20   for number in range(1, {shards} + 1)\n\
         ]\n\
         job.program(\n\
         \x20   [{program}, \"merge\", {folder}, \"--output\", {result}, \"--quiet\"],\n\
         \x20   stdout=engine + \"/merge.log\",\n\
         \x20   stderr=engine + \"/merge.err\",\n\
         \x20   deps=shards,\n\
         )\n\
         try:\n\
         \x20   client = Client(os.environ.get(\"HQ_SERVER_DIR\"))\n\
         except Exception as error:\n\
         \x20   reason = str(error).split(\"\\n\")[0]\n\
         \x20   sys.exit(f\"no HyperQueue server can be reached: {{reason}}\")\n\
         print(client.submit(job).id)\n",
        job = submission.job,
        shards = submission.shards,
        engine = text(&engine),
        program = text(&submission.program),
        folder = text(&submission.folder),
        result = text(&submission.result)
    );
    vec![("submit.py", script)]
}

pub(super) fn submit(submission: &Submission) -> Result<Submitted, EngineError> {
    let script = folder(&submission.folder).join("submit.py");
    let job = answer_of(Command::new(PYTHON).arg(script), PYTHON, HELP)?;
    Ok(Submitted { shards: job.clone(), merge: job })
}
