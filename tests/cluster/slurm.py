"""A Slurm of its own for a test: munge, a controller and two nodes on this machine, with all that they keep in one folder
and under the user who runs the test. A node is a slurmd with a name and a port of its own."""
import os
import pwd
import signal
import socket
import subprocess

from harness import FFD, wait_until

NODES = ("node1", "node2")
SECONDS = 90
# Debian's folder of daemons is not in everybody's path.
PATH = os.environ["PATH"] + os.pathsep + "/usr/sbin"

CONFIGURATION = """
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdSpoolDir={folder}/spool-%n
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
# A node that was given up is taken back when it answers; its jobs are submitted again by the test.
ReturnToService=2
JobRequeue=0
# Nothing waits for company: a job is begun when it comes, and sbatch --wait asks every two seconds. (It asks the less
# often the longer a job that has ended is remembered.)
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=1
MinJobAge=5
NodeName=node1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2
NodeName=node2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def process(pid):
    """The name, the parent and the environment of a process; nothing of one that is gone."""
    try:
        with open(f"/proc/{pid}/status", encoding="latin-1") as file:
            status = dict(line.rstrip("\n").split(":\t", 1) for line in file if ":\t" in line)
        with open(f"/proc/{pid}/environ", encoding="latin-1") as file:
            return status["Name"], int(status["PPid"]), file.read().split("\0")
    except (OSError, KeyError, ValueError):
        return "", 0, []


class Slurm:
    def __init__(self, folder):
        """The folder must be within everyone's reach: munge wants that of its socket."""
        self.folder = folder
        self.daemons = {}
        os.mkdir(self.path("bin"))
        os.symlink(FFD, self.path("bin/ffd"))
        for name in ("state", "cache", *(f"spool-{node}" for node in NODES)):
            os.mkdir(self.path(name))
        with open(self.path("slurm.conf"), "w", encoding="ascii") as file:
            file.write(CONFIGURATION.format(folder=folder, ports=free_ports(3), user=pwd.getpwuid(os.geteuid()).pw_name))
        self.environment = {"PATH": self.path("bin") + os.pathsep + PATH, "SLURM_CONF": self.path("slurm.conf"), "HOME": folder,
                            "XDG_CACHE_HOME": self.path("cache")}

    def path(self, name):
        return os.path.join(self.folder, name)

    def __enter__(self):
        try:
            self.start_munge()
            self.start("slurmctld", "slurmctld", "-D")
            for node in NODES:
                self.start_node(node)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        pids = self.processes(NODES)
        for name in reversed(self.daemons):
            self.stop(name)
        for pid in pids:
            kill(pid)

    def start(self, name, *command):
        """Starts a daemon that ends with this process, however that ends."""
        with open(self.path(name + ".out"), "wb") as out:
            self.daemons[name] = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *command], env=self.environment,
                                                  stdin=subprocess.DEVNULL, stdout=out, stderr=out)

    def stop(self, name):
        daemon = self.daemons[name]
        daemon.terminate()
        try:
            daemon.wait(10)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()

    def start_munge(self):
        with open(self.path("munge.key"), "wb") as file:
            os.fchmod(file.fileno(), 0o600)
            file.write(os.urandom(1024))
        self.start("munged", "munged", "--foreground", *(
            f"--{what}={self.path('munge.' + end)}" for what, end in (
                ("key-file", "key"), ("socket", "socket"), ("pid-file", "pid"), ("log-file", "log"), ("seed-file", "seed"))))
        wait_until(lambda: os.path.exists(self.path("munge.socket")), "munged")

    def start_node(self, node):
        self.start(node, "slurmd", "-D", "-N", node)
        try:
            wait_until(lambda: self.ask("sinfo", "-h", "-N", "-n", node, "-o", "%T") in (["idle"], ["mixed"]), f"{node} is not up")
        except AssertionError as problem:
            with open(self.path(node + ".out"), encoding="utf-8") as file:
                raise AssertionError(f"{problem}; it says:\n{file.read()[-2000:]}") from None

    def run(self, *command):
        """Runs a command of Slurm's."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=SECONDS, check=False)

    def ask(self, *command):
        """The lines that a command of Slurm's prints; none while nobody answers."""
        done = self.run(*command)
        return done.stdout.split("\n")[:-1] if done.returncode == 0 else []

    def running(self):
        """The node of each running array task."""
        return {int(line.split()[0]): line.split()[1] for line in self.ask("squeue", "-h", "-r", "-t", "R", "-o", "%K %N")}

    def processes(self, nodes):
        """What runs in jobs on the nodes: first Slurm's own keepers of the jobs, then the jobs' processes."""
        keepers, jobs = [], []
        for pid in (int(name) for name in os.listdir("/proc") if name.isdigit()):
            _, parent, environment = process(pid)
            if f"SLURM_CONF={self.path('slurm.conf')}" in environment and any(
                    f"SLURMD_NODENAME={node}" in environment for node in nodes):
                jobs.append(pid)
                if process(parent)[0].startswith("slurmstepd"):
                    keepers.append(parent)
        return keepers + jobs

    def kill_node(self, node):
        """As if the machine had lost its power: nothing on it says a last word."""
        self.daemons[node].kill()
        self.daemons[node].wait()
        while pids := self.processes([node]):
            for pid in pids:
                kill(pid)

    def give_up(self, node):
        """Tells the controller that a node is dead, which it would find by itself half a minute later."""
        self.run("scontrol", "update", f"nodename={node}", "state=down", "reason=killed")


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
