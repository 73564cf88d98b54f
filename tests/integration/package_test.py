"""The Debian packages, in a root that has nothing but a minimal Debian: they install, train, also as services, are built
against, show a run in lcm-spy, and go without a trace."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

import spy_display
from fresco_process import READY_EXPERIMENTS, ROOT, FrescoTest, url

BUILD = pathlib.Path(os.environ["FRESCO_BUILD"])
NEEDED = {"cpack": "cmake", "dpkg-shlibdeps": "dpkg-dev", "help2man": "help2man", "ip": "iproute2", "man": "man-db",
          "mmdebstrap": "mmdebstrap", "systemd-nspawn": "systemd-container", "unshare": "util-linux", "Xvfb": "xvfb"}
PACKAGES = ["fresco", "libfresco-dev", "fresco-spy"]
USER = "1000:1000"  # the user and group that the programs run as, who need no name
HOME = pathlib.Path("/home/user")
# In namespaces of its own, so that nothing is left mounted, and the end of `unshare` or of its shell ends all processes.
# The shell must not become chroot (exec): that changes the user, and then the kernel forgets to end it.
IN_ROOT = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
# As an ordinary user, with no network but multicast over loopback, and with the displays of the host. The argument after
# it is the root.
WITHOUT_NETWORK = [*IN_ROOT, "--net", "sh", "-ec", """
  ip link set lo up
  ip route add 224.0.0.0/4 dev lo
  mount -t proc proc "$0/proc"
  mkdir -p "$0/tmp/.X11-unix" /tmp/.X11-unix
  mount --bind /tmp/.X11-unix "$0/tmp/.X11-unix"
  chroot --userspec=%s "$0" env -i -C "$HOME" HOME="$HOME" PATH=/usr/bin:/bin DISPLAY="$DISPLAY" "$@"
  exit 0""" % USER]
# What systemd runs after the root has booted: a learner and an actor with a key, and an actor of another run without one.
SERVICES = """#!/bin/sh
ip route add 224.0.0.0/4 dev lo
systemctl start fresco-actor@with_key fresco-actor@without fresco-learner@with_key
while systemctl --quiet is-active fresco-learner@with_key; do sleep 0.1; done
cp /var/lib/fresco/with_key/run/summary.json /trial
systemctl is-active fresco-learner@with_key fresco-actor@with_key fresco-actor@without >/trial/states
systemctl --no-pager --full status fresco-actor@with_key >/trial/status
journalctl --no-pager --output=cat --unit='fresco-*' >/trial/journal
systemctl stop 'fresco-*'
systemctl poweroff --force --force
"""
# As root and with the network: for apt.
AS_ROOT = [*IN_ROOT, "sh", "-ec", """
  mount -t proc proc "$0/proc"
  chroot "$0" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"
  exit 0"""]


def why_not():
    """Why it can't be tried here; empty: it can."""
    missing = [package for program, package in NEEDED.items() if shutil.which(program) is None]
    if missing:
        return f"needs the Debian packages {' '.join(missing)}: apt-get install {' '.join(missing)}"
    return "" if os.geteuid() == 0 else "only root may make a root for packages"


def sources():
    """The files that say where this machine gets its packages."""
    folder = pathlib.Path("/etc/apt")
    return [path for path in [folder / "sources.list", *sorted((folder / "sources.list.d").glob("*"))]
            if path.suffix in (".list", ".sources") and path.exists()]


@unittest.skipIf(why_not(), why_not())
class Packages(FrescoTest):
    def setUp(self):
        super().setUp()
        self.root = self.folder / "root"
        self.began = time.monotonic()

    def passed(self, step):
        """Tells how long everything took until now."""
        print(f"{time.monotonic() - self.began:6.1f} s: {step}", file=sys.stderr, flush=True)

    def run_command(self, *command, expect=0, **options):
        process = self.start_command([*map(str, command)], **options)
        output, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, expect, f"{command}\n{output}\n{errors}")
        return output, errors

    def as_user(self, *command, **options):
        return self.run_command(*WITHOUT_NETWORK, self.root, *command,
                                env=dict(os.environ, HOME=str(HOME), DISPLAY=""), **options)[0]

    def as_root(self, *command):
        return self.run_command(*AS_ROOT, self.root, *command)[0]

    def install(self, package, *debian_packages):
        """The package as a person would: from its file, with what it depends on and nothing that it only recommends."""
        [file] = (self.root / "packages").glob(f"{package}_*.deb")
        self.as_root("apt-get", "install", "--yes", "--no-install-recommends", f"/packages/{file.name}", *debian_packages)
        self.passed(f"{package} is installed")

    def test_install_work_and_are_removed_without_a_trace(self):
        self.make_root()
        self.make_packages()
        self.install("fresco", "python3")
        self.check_programs()
        self.check_manual_pages()
        self.check_completion()
        self.check_services()
        self.check_training()
        self.install("libfresco-dev", "cmake", "g++", "make")
        self.check_consumer()
        self.install("fresco-spy")
        self.check_spy()
        self.check_removal()

    def make_root(self):
        codename = re.search(r"VERSION_CODENAME=(\w+)", pathlib.Path("/etc/os-release").read_text())[1]
        self.run_command("mmdebstrap", "--quiet", "--variant=minbase", "--include=systemd-sysv,iproute2", "--skip=cleanup/apt/lists",
                         "--dpkgopt=force-unsafe-io", codename, self.root, *sources())
        home = self.root / HOME.relative_to("/")
        home.mkdir(parents=True)
        os.chown(home, *map(int, USER.split(":")))
        self.passed("a clean root is there")

    def make_packages(self):
        self.run_command("cpack", "-G", "DEB", "-B", self.root / "packages", "--config", BUILD / "CPackConfig.cmake")
        shutil.rmtree(self.root / "packages" / "_CPack_Packages")
        self.assertEqual(sorted(file.name.split("_")[0] for file in (self.root / "packages").iterdir()), sorted(PACKAGES))
        self.passed("the packages are made")

    def check_programs(self):
        for program in ("fresco", "fresco-actor", "fresco-learner", "fresco-world"):
            self.assertRegex(self.as_user(program, "--version"),
                             rf"^{program} \d+\.\d+\.\d+, commit \S+" + ("" if program == "fresco-world" else ", arithmetic"))

    def commands(self):
        """Every command of `fresco` that an installation has, as its help lists them: ["train"], …, ["log", "record"], …"""
        def below(*command):
            text = self.as_user("fresco", *command, "--help")
            names = re.findall(r"^  ([a-z]+) ", text.partition("Subcommands:")[2], re.MULTILINE)
            return [found for name in names if name != "bench" for found in [[*command, name], *below(*command, name)]]
        return below()

    def check_manual_pages(self):
        commands = self.commands()
        self.assertIn(["log", "record"], commands)
        for command in commands:
            page = self.root / "usr/share/man/man1" / f"{'-'.join(['fresco', *command])}.1.gz"
            text, warnings = self.run_command("man", "--warnings", "--no-justification", "--local-file", page,
                                              env=dict(os.environ, MANWIDTH="100", LC_ALL="C.UTF-8"))
            self.assertEqual(warnings, "", page)
            self.assertIn(f"fresco-{'-'.join(command)} - ", text)
            self.assertRegex(text, r"SYNOPSIS\n +fresco " + " ".join(command))
            self.assertIn("-h, --help", text)

    def check_completion(self):
        """What bash is offered after some words of which the last one is not finished."""
        def offers(*words):
            script = """. /usr/share/bash-completion/completions/"$1"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
              _fresco; echo "${COMPREPLY[@]}" """
            return self.as_user("bash", "-c", script, "bash", *words).split()
        top = [command[0] for command in self.commands() if len(command) == 1]
        self.assertEqual(offers("fresco", ""), ["--help", "--version", *top, "bench"])
        self.assertEqual(offers("fresco", "log", "re"), ["record", "repair"])
        self.assertEqual(offers("fresco", "train", "--reco"), ["--record", "--record-split-mb"])
        self.assertEqual(offers("fresco", "train", "--config", ""), READY_EXPERIMENTS.split(", "))
        self.assertEqual(offers("fresco", "train", "--format", "=", "j"), ["json"])
        self.assertEqual(offers("fresco", "train", "--out", ""), [])  # bash then offers files
        self.assertEqual(offers("fresco-actor", "--lcm"), ["--lcm-url"])

    def check_services(self):
        """The root boots, and learner and actors train there as users of their own, with the key that root alone can read."""
        self.as_root("systemd-analyze", "verify", "--man=no", "fresco-actor@x.service", "fresco-learner@x.service")
        container = ["systemd-nspawn", "--quiet", "--register=no", "--keep-unit", "--private-network", "--directory", self.root]
        possible = subprocess.run([*container, "true"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if possible.returncode != 0:  # within some other containers
            self.passed(f"the services are not tried, since systemd-nspawn can't start here: {possible.stderr.strip()}")
            return
        trial, options, keys = (self.root / folder for folder in ("trial", "etc/fresco", "etc/credstore"))
        for folder in (trial, options, keys):
            folder.mkdir(exist_ok=True)
        self.key().rename(keys / "fresco-with_key.key")
        (options / "with_key.env").write_text(f"EXPERIMENT=--config ci --set schedule.episodes=100\nOPTIONS=--lcm-url {url(7667)}\n")
        (options / "without.env").write_text(f"OPTIONS=--lcm-url {url(7668)}\n")
        (trial / "run").write_text(SERVICES)
        (trial / "run").chmod(0o755)
        unit = self.root / "etc/systemd/system/trial.service"
        unit.write_text("[Service]\nType=oneshot\nExecStart=/trial/run\n")
        wanted = self.root / "etc/systemd/system/multi-user.target.wants/trial.service"
        wanted.symlink_to(unit.name)
        self.run_command(*container, "--boot", stdin=subprocess.DEVNULL)
        journal = (trial / "journal").read_text()
        self.assertEqual((trial / "states").read_text().split(), ["inactive", "active", "active"], journal)
        summary = json.loads((trial / "summary.json").read_text())
        self.assertEqual((summary["completed"], summary["episodes"]), (True, 100), journal)
        self.assertEqual(summary["bus"]["rejected_unauthenticated"], 0)
        self.assertIn("--key-file /run/credentials/fresco-actor@with_key.service/key", (trial / "status").read_text())
        for file in (unit, wanted):
            file.unlink()
        for folder in (trial, options, keys, self.root / "var/lib/fresco", self.root / "var/lib/private/fresco"):
            shutil.rmtree(folder)
        self.passed("the services have trained")

    def check_training(self):
        self.as_user("fresco", "train", "--config", "ci", "--out", "run", "--record", "--format", "json")
        self.passed("the main job has run")
        rows = self.as_user("python3", "-c", """if True:
            import fresco_log
            print(sum(1 for row in fresco_log.EventLog("run/traffic.lcm").transitions()))""")
        self.assertEqual(int(rows) + 1, len(self.as_user("fresco", "log", "export", "run/traffic.lcm").splitlines()))

    def check_consumer(self):
        """The example finds the libraries, and the optimum that the program finds; without a library that it needs, the
        error tells the package."""
        shutil.copytree(ROOT / "examples" / "consumer", self.root / "consumer")
        configure = ["cmake", "-S", "/consumer", "-B", "build"]
        _, errors = self.run_command(*WITHOUT_NETWORK, self.root, *configure, "-DCMAKE_DISABLE_FIND_PACKAGE_PNG=ON", expect=1,
                                     env=dict(os.environ, HOME=str(HOME), DISPLAY=""))
        self.assertIn("apt-get install libpng-dev", " ".join(errors.split()))
        self.as_user(*configure, "-DCMAKE_DISABLE_FIND_PACKAGE_PNG=OFF")
        self.as_user("cmake", "--build", "build")
        output = self.as_user("build/consumer", "/usr/share/fresco/configs/ci.textproto")
        optimum = re.search(r"average_aoi (\S+)", output)[1]
        told = self.as_user("fresco", "evaluate", "--config", "ci", "--policy", "optimal")
        self.assertIn(optimum, told)
        told = self.as_user("fresco", "evaluate", "--policy", "run")
        self.assertIn(self.as_user("build/act", "run").strip(), told)
        self.passed("a program was built against the libraries")

    def check_spy(self):
        display = self.enterContext(spy_display.Display())
        script = """fresco train --config ci --out "$HOME/watched" --set schedule.episodes=1000000 >"$HOME/log" 2>&1 &
          fresco spy --print-table"""
        spy = self.start_command([*WITHOUT_NETWORK, self.root, "sh", "-c", script],
                                 env=dict(display.environment, HOME=str(HOME)), stderr=subprocess.DEVNULL)
        for line in spy.stdout:
            if re.match(r"FRESCO_LEARNER_STATUS +learner_status_t +[1-9]\d* +0$", line):
                break
        else:
            self.fail("fresco spy ended without a status of the learner")
        spy.kill()
        spy.communicate(timeout=30)  # the end of the output is the end of all processes
        self.passed("lcm-spy has shown a run")

    def check_removal(self):
        shutil.rmtree(self.root / "consumer")
        shutil.rmtree(self.root / "packages")
        shutil.rmtree(self.root / HOME.relative_to("/"))
        self.assertNotEqual(self.traces(), [])
        self.as_root("apt-get", "purge", "--yes", *PACKAGES)
        self.assertEqual(self.traces(), [])
        self.passed("the packages are removed")

    def traces(self):
        """Everything that is named after Fresco."""
        return [str(path) for path in self.root.rglob("*[fF]resco*")]


if __name__ == "__main__":
    sys.exit(unittest.main())
