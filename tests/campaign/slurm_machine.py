"""A Slurm of one node on the loopback, in a folder of its own: its own munge, ports and state. Needs root (slurmd)."""
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from patience import PATIENCE  # noqa: E402

NEEDED = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")


def lacking():
    """What is missing for a Slurm here, or ""."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    missing = [program for program in NEEDED if shutil.which(program, path=path) is None]
    if missing:
        return "no " + ", ".join(missing) + " here (Debian: slurm-wlm, munge)"
    return "" if os.geteuid() == 0 else "slurmd needs root"


def free_ports(count):
    holders = [socket.socket() for _ in range(count)]
    for holder in holders:
        holder.bind(("127.0.0.1", 0))
    ports = [holder.getsockname()[1] for holder in holders]
    for holder in holders:
        holder.close()
    return ports


class SlurmMachine:
    def __init__(self, cpus=2):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="millscope-slurm-"))
        self.folder.chmod(0o755)
        self.host = socket.gethostname().split(".")[0]
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf"), "PATH": os.environ.get("PATH", "") + ":/usr/sbin:/sbin"}
        self.processes = {}
        try:
            self.configure(cpus)
            self.start_munge()
            self.start_controller()
            self.start_daemon("slurmd", ["slurmd", "-D"])
            self.wait_until(lambda: self.ask("sinfo", "-h", "-o", "%t").strip() in ("idle", "mix", "alloc"), "the node was ready")
        except BaseException:
            self.stop()
            raise

    def configure(self, cpus):
        controller, node = free_ports(2)
        for name in ("ctld", "d"):
            (self.folder / name).mkdir()
        (self.folder / "slurm.conf").write_text(f"""\
ClusterName=local
SlurmctldHost={self.host}(127.0.0.1)
SlurmUser=root
AuthInfo=socket={self.folder}/munge.socket
SlurmctldPort={controller}
SlurmdPort={node}
StateSaveLocation={self.folder}/ctld
SlurmdSpoolDir={self.folder}/d
SlurmctldPidFile={self.folder}/ctld.pid
SlurmdPidFile={self.folder}/d.pid
SlurmctldLogFile={self.folder}/ctld.log
SlurmdLogFile={self.folder}/d.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0
ReturnToService=2
KillWait=5
MinJobAge=10
NodeName={self.host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""", encoding="utf-8")

    def start_munge(self):
        key = self.folder / "munge.key"
        key.write_bytes(secrets.token_bytes(128))
        key.chmod(0o400)
        names = {option: str(self.folder / f"munge.{option}") for option in ("socket", "pid", "log", "seed")}
        self.start_daemon("munged", ["munged", "--foreground", "--force", "--num-threads=2", f"--key-file={key}", f"--socket={names['socket']}",
                                     f"--pid-file={names['pid']}", f"--log-file={names['log']}", f"--seed-file={names['seed']}"])
        self.wait_until(lambda: (self.folder / "munge.socket").exists(), "munged answered")

    def start_controller(self):
        self.start_daemon("slurmctld", ["slurmctld", "-D"])
        self.wait_until(lambda: "UP" in self.ask("scontrol", "ping"), "slurmctld answered")

    def start_daemon(self, name, words):
        log = open(self.folder / f"{name}.out", "ab")
        with log:
            self.processes[name] = subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=self.folder)

    def stop_controller(self):
        """In order, as an administrator does: a controller that is killed may forget what it has just started."""
        process = self.processes.pop("slurmctld")
        process.terminate()
        process.wait(30)

    def ask(self, *words):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True, timeout=PATIENCE).stdout

    def tasks(self):
        """"<job>_<task>" → (state, job name)."""
        rows = [row.split("|") for row in self.ask("squeue", "-h", "-r", "-o", "%F_%K|%T|%j").splitlines()]
        return {row[0]: (row[1], row[2]) for row in rows}

    def wait_until(self, condition, what):
        end = time.monotonic() + PATIENCE
        while not condition():
            for name, process in self.processes.items():
                if process.poll() is not None:
                    raise RuntimeError(f"{name} ended: " + (self.folder / f"{name}.out").read_text(errors="replace")[-500:])
            if time.monotonic() > end:
                raise RuntimeError(f"waited in vain until {what}")
            time.sleep(0.1)

    def stop(self):
        if "slurmctld" in self.processes:
            self.ask("scancel", "--user=root", "--full")
        for name in ("slurmd", "slurmctld", "munged"):
            process = self.processes.pop(name, None)
            if process is None:
                continue
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait(10)
        shutil.rmtree(self.folder, ignore_errors=True)
