"""The pages in docs/ as a reader follows them: every command of every block that is marked `sh`, in order, in one shell.
Of all other commands in README.md and docs/: programs, subcommands, options and files that they name exist."""
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ["FRESCO_BIN"])
BUILD = pathlib.Path(os.environ["FRESCO_BUILD"])
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "docs" / "results" / "README.md"]
PROGRAMS = {"tools/fresco": "fresco", "fresco": "fresco", "build/release/bin/fresco-actor": "fresco-actor",
            "fresco-actor": "fresco-actor", "build/release/bin/fresco-world": "fresco-world"}
NOT_OF_THE_PROGRAM = {"test", "package"}  # what the script tools/fresco does itself


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)


class Pages(unittest.TestCase):
    """Each in a network namespace of its own, since a reader has the default port for himself."""

    @classmethod
    def setUpClass(cls):
        if subprocess.run(["unshare", "-Urn", "true"], capture_output=True).returncode != 0:
            raise unittest.SkipTest("needs network namespaces")

    def follow(self, name, *shorter, before=""):
        """Runs the page's commands, after those that make what the reader has already; `shorter` replaces parts of them
        that would take long."""
        return self.run_script("\n".join([before, *blocks(ROOT / "docs" / name, "sh")]), *shorter)

    def run_script(self, script, *shorter):
        for text, replacement in shorter:
            self.assertIn(text, script)
            script = script.replace(text, replacement)
        with tempfile.TemporaryDirectory(prefix="fresco-walk-") as folder:
            path = pathlib.Path(folder)
            for link in ("configs", "examples", "plugins", "tests"):
                (path / link).symlink_to(ROOT / link)
            (path / "tools").mkdir()
            (path / "tools" / "map_picture").symlink_to(ROOT / "tools" / "map_picture")
            program = path / "tools" / "fresco"
            program.write_text(f'#!/bin/bash\nexec -a tools/fresco {shlex.quote(str(BIN / "fresco"))} "$@"\n')
            program.chmod(0o755)
            (path / "build").mkdir()
            (path / "build" / "release").symlink_to(BUILD)
            command = ["unshare", "-Urn", "bash", "-euc", f"ip link set lo up; ip route add 224.0.0.0/4 dev lo\n{script}"]
            result = subprocess.run(command, cwd=path, capture_output=True, text=True, timeout=500)
            self.assertEqual(result.returncode, 0, f"{result.stdout}\n{result.stderr}")
            self.files = {file.name for file in path.rglob("*") if file.is_file() and not file.is_symlink()}
            return result.stdout

    def test_what_the_readme_proposes_after_a_training(self):
        script = next(block for block in blocks(ROOT / "README.md", "") if "evaluate --policy runs/NAME" in block)
        output = self.run_script("tools/fresco train --config ci --out runs/NAME\n" + script,
                                 ("--config cartpole --seed 2", "--config cartpole --seed 2 --set schedule.episodes=20"),
                                 # These have tests of their own: resume_test, watch_test, spy_test.
                                 *((f"tools/fresco {command}", ": ") for command in ("train --resume", "watch ", "spy ")))
        self.assertIn("arrived; average AoI", output)
        self.assertRegex(output, r"(?m)^NAME +14\.576 ")
        self.assertIn("Training works on this machine.", output)
        self.assertLessEqual({"compare.html", "policy.onnx"}, self.files)

    def test_a_figure_of_your_own(self):
        output = self.follow("walkthrough-researcher.md", ("episodes: 3000", "episodes: 200 minimum_replay_size: 1000"),
                             ("figures --config", "figures --quick --config"))
        self.assertIn("runs that differ in the seed alone", output)
        self.assertRegex(output, r"mine, seed-2, seed-3 +3 ")
        self.assertRegex(output, r"(?m)^sensors,deployments,dqn_average_aoi,dqn_half_width,")
        self.assertLessEqual({"compare.html", "my_sensors.svg", "sensors.svg"}, self.files)

    def test_see_record_and_replay_the_traffic(self):
        output = self.follow("walkthrough-traffic.md", ("train --record", "train --config ci --set schedule.episodes=2500 --record"))
        self.assertRegex(output, r"(?m)^run [0-9a-f]{16}, world uav$")
        self.assertIn("FRESCO_TRANSITIONS", output)
        live, again = re.findall(r"(?m)^(?:live|again) .* ([0-9a-f]{8})$", output)
        self.assertEqual(live, again)
        self.assertRegex(output, r"2500 episodes, \d+ updates, best score \d+")
        self.assertLessEqual({"mine.lcm", "run.mcap", "run.svg", "FRESCO_TRANSITIONS.csv"}, self.files)

    def test_a_world_of_your_own(self):
        output = self.follow("walkthrough-world.md")
        one, four = re.findall(r"(?m)^python(?:-4)? .* ([0-9a-f]{8})$", output)
        self.assertEqual(one, four)
        self.assertEqual(len(re.findall(r"(?m)^  this run \(DQN\) .*yes$", output)), 3, output)
        self.assertIn("corridor_policy.h", self.files)

    def test_logs_and_lcms_own_tools(self):
        few = "--config ci --set schedule.episodes=100"
        output = self.follow(
            "lcm.md",
            ("train --record  ", f"train {few} --record  "),
            ("train --record --record-split-mb 500", f"train {few} --record --record-split-mb 1"),
            ("tools/fresco train --resume DIR", ": "),  # resume_test
            ("log record --out run.lcm  ", "log record --seconds 0.1 --out nothing.lcm  "),
            ("--seconds 60", "--seconds 0.1"), ("--seconds 5", "--seconds 0.1"),
            ("lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304' run.lcm",
             "timeout --preserve-status 0.5 lcm-logger --lcm-url='udpm://239.255.76.67:7667?ttl=0' logged.lcm"),
            ("--run 588392cf45293d13", "--run $(tools/fresco log info many.lcm | grep -oP '^run \\K\\w+')"),
            ("--channel FRESCO_LEARNER_STATUS", "--channel FRESCO_LEARNER_STATUS --seconds 0.1"),
            ("--start 60 --stop 120 --loop", "--start 1 --stop 2"),
            ("lcm-logplayer-gui run.lcm ", "true "),  # a window
            ("schedule.episodes=1500", "schedule.episodes=100"), ("runs/live $QUICK", "runs/live-2 $QUICK"),
            ("runs/live/traffic.lcm --out runs/again $QUICK", "runs/live-2/traffic.lcm --out runs/again-2 $QUICK"),
            ("tools/fresco watch  ", ":  "),  # watch_test
            ("tools/fresco doctor --hosts", ": "),  # doctor_test
            ("runs/NAME --loop", "runs/live --rate 1000"), ("tools/fresco spy", ": "),  # spy_test
            before=f"tools/fresco train {few} --record --out runs/first\n"
                   "cp runs/first/traffic.lcm run.lcm; cp run.lcm many.lcm\n")
        weights = re.findall(r"weights_crc32c\": ?\"(\w+)", output)
        self.assertEqual(len(weights), 2)
        self.assertEqual(*weights)
        self.assertLessEqual({"run.mcap", "FRESCO_ORDERS.csv", "transitions.csv", "repaired.lcm", "small.lcm"}, self.files)

    def test_exports(self):
        self.follow("export.md", before="tools/fresco train --config ci --set schedule.episodes=50 --out runs/NAME\n")
        self.assertLessEqual({"policy.onnx", "policy.h", "policy.csv"}, self.files)

    def test_other_worlds(self):
        few = " --set schedule.episodes=20 --set schedule.minimum_replay_size=100 --set run.optimum_limit_s=0 "
        output = self.follow(
            "worlds.md", ("--config cartpole  ", "--config cartpole --out runs/NAME" + few),
            ("--config FIELD --policy runs/NAME", "--config ci --policy runs/fields"),
            ("train --config city  ", "train --config city" + few), ("configs/city.png  ", "city.png  "),
            ("episodes: 500", "episodes: 20 minimum_replay_size: 500"), ("episodes: 200 ", "episodes: 20 minimum_replay_size: 100 "),
            before=f"tools/fresco train --config any_field --out runs/fields{few}\n")
        self.assertRegex(output, r'"total_aoi": ?\d+')
        self.assertIn("city.png", self.files)

    def test_a_key(self):
        output = self.follow(
            "reliability.md", ("scp ", ": "), ("  # host 1", " --config ci --set schedule.episodes=50 &"),
            ("fresco-actor --lcm-url", "fresco-actor --once --lcm-url"), ("  # host 2", "; wait $!"),
            before="URL='udpm://239.255.76.67:7667?ttl=0'\n")
        self.assertIn("this run (DQN)", output)


class OtherCommands(unittest.TestCase):
    """Commands that take long, or need a display or other hosts, are not followed, and many of them are run by other tests.
    Here they are checked."""

    def help_of(self, words):
        if words not in self.helps:
            result = subprocess.run([BIN / PROGRAMS[words[0]], *words[1:], "--help"], capture_output=True, text=True)
            self.helps[words] = result.stdout if result.returncode == 0 else ""
        return self.helps[words]

    def check(self, command, place):
        words = tuple(shlex.split(command, comments=True))
        program, arguments = words[:1], words[1:]
        while arguments and re.search(rf"(?m)^  {re.escape(arguments[0])} ", self.help_of(program).partition("Subcommands:")[2]):
            program, arguments = program + arguments[:1], arguments[1:]
        if not arguments[:1] or arguments[0] not in NOT_OF_THE_PROGRAM or len(program) > 1:
            self.assertNotIn("Subcommands:", self.help_of(program) if arguments else "", f"{place}: {command}")
            for option in (word.partition("=")[0] for word in arguments if word.startswith("--")):
                self.assertRegex(self.help_of(program), rf"(?m)^  (-h,)?{option}\b", f"{place}: {command}")
        for config in re.findall(r"--config (?:configs/)?(\w+)(?:\.textproto)?(?= |$)", command):
            made_by_reader = f"{config}.textproto <<" in place.read_text() or config.isupper() or config == "mountain_car"
            self.assertTrue(made_by_reader or (ROOT / "configs" / f"{config}.textproto").exists(), f"{place}: {command}")

    def test_name_what_exists(self):
        self.helps, checked = {}, 0
        for page in PAGES:
            for block in blocks(page, r"\w*"):
                for line in block.replace("\\\n", " ").splitlines():
                    command = re.sub(r"'[^']*'|\"[^\"]*\"|\$\w+", "X", re.sub(r"(^|\s)#.*", "", line.strip()))
                    command = re.sub(r"\s*[|>&].*", "", command)
                    if command.split(" ")[0] in PROGRAMS and not re.match(r"\S+ +\d", command):  # or a row of a table
                        self.check(command, page)
                        checked += 1
        self.assertGreater(checked, 70)


if __name__ == "__main__":
    unittest.main()
