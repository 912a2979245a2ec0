"""A job's shards through HyperQueue's LocalCluster: the scripts that `orthocert submit` writes, on a
server and workers in this process. Called by hyperqueue.sh, which gives the mishaps.

Usage: local_cluster.py ORTHOCERT FOLDER RESULT SECONDS
"""

import os
import subprocess
import sys
import time

from hyperqueue.cluster import LocalCluster, WorkerConfig

orthocert, folder, result, seconds = sys.argv[1:]
# What a merge writes last.
last = result if result.endswith(".paving") else os.path.join(result, "atlas.cert.json")
with LocalCluster() as cluster:
    cluster.start_worker(WorkerConfig(cores=1))
    cluster.start_worker(WorkerConfig(cores=1))
    submit = [orthocert, "submit", folder, "--engine", "hyperqueue", "--output", result]
    server = dict(os.environ, HQ_SERVER_DIR=str(cluster.cluster.server_dir))
    subprocess.run(submit, env=server, check=True)
    end = time.monotonic() + float(seconds)
    while not os.path.exists(last):
        if time.monotonic() > end:
            sys.exit(f"the merge was not finished within {seconds} s")
        time.sleep(0.2)
