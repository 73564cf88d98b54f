"""What `cmake --install` installs works by itself: from every folder, at any place, without the source tree."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

from fresco_process import CI_CONFIG, PATIENCE, ROOT, READY_EXPERIMENTS, FrescoTest, url

BUILD = pathlib.Path(os.environ["FRESCO_BUILD"])
PROGRAMS = ["fresco", "fresco-actor", "fresco-learner", "fresco-world"]
# In a mount namespace of its own, where the source tree, and the build tree in it, is an empty folder.
WITHOUT_SOURCES = ["unshare", "--mount", "sh", "-c", 'mount -t tmpfs none "$0" && exec "$@"', ROOT]


class Installation(FrescoTest):
    def setUp(self):
        super().setUp()
        self.prefix = self.folder / "prefix"
        installed = self.folder / "installed"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", installed], check=True, stdout=subprocess.DEVNULL)
        shutil.move(installed, self.prefix)  # nothing may depend on the place that it was installed to
        self.elsewhere = self.folder / "elsewhere"
        self.elsewhere.mkdir()

    def run_installed(self, *arguments, expect=0):
        hidden = WITHOUT_SOURCES if os.geteuid() == 0 else []
        environment = {"PATH": f"{self.prefix / 'bin'}:/usr/bin:/bin", "HOME": str(self.elsewhere)}
        options = {name: value for name, value in os.environ.items() if name.endswith("SAN_OPTIONS")}
        process = self.start_command([*hidden, *map(str, arguments)], cwd=self.elsewhere, env=environment | options)
        output, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, expect, f"{arguments}\n{output}\n{errors}")
        return output, errors

    def test_has_the_programs_and_the_ready_experiments(self):
        self.assertEqual(sorted(path.name for path in (self.prefix / "bin").iterdir()), PROGRAMS)
        configs = self.prefix / "share" / "fresco" / "configs"
        self.assertEqual({path.name: path.read_bytes() for path in configs.iterdir()},
                         {path.name: path.read_bytes() for path in (ROOT / "configs").iterdir()})
        for jar in (BUILD / "share" / "fresco").glob("*.jar"):
            self.assertEqual((self.prefix / "share" / "fresco" / jar.name).read_bytes(), jar.read_bytes())

    @unittest.skipIf(PATIENCE > 1, "a sanitizer's reports name the sources")
    def test_has_no_path_of_the_machine_that_built_it(self):
        for program in PROGRAMS:
            content = (self.prefix / "bin" / program).read_bytes()
            for path in (ROOT, BUILD):
                self.assertNotIn(str(path).encode(), content, program)

    def test_trains_and_evaluates_from_every_folder_without_the_source_tree(self):
        own_config = self.elsewhere / "own.textproto"  # that of the tests: short, also with a sanitizer
        own_config.write_text(CI_CONFIG.read_text())
        output, _ = self.run_installed("fresco", "train", "--config", "own.textproto", "--lcm-url", url(17342), "--out",
                                       "run", "--format", "json")
        summary = json.loads(output)
        self.assertTrue(summary["completed"])
        output, _ = self.run_installed("fresco", "evaluate", "--policy", "run", "--format", "json")
        self.assertEqual(json.loads(output)["total_aoi"], summary["total_aoi"])

    def test_has_the_python_module_that_reads_logs(self):
        self.run_installed("fresco", "train", "--lcm-url", url(17346), "--out", "run", "--record", "--set",
                           "schedule.episodes=20", "--set", "run.optimum_limit_s=0")
        program = """if True:
            import collections, json, sys
            sys.path.insert(0, sys.argv[1])
            import fresco_log
            print(json.dumps(collections.Counter(event.channel for event in fresco_log.EventLog("run/traffic.lcm"))))"""
        output, _ = self.run_installed("python3", "-B", "-c", program, self.prefix / "lib/python3/dist-packages")
        info = json.loads(self.run_installed("fresco", "log", "info", "run/traffic.lcm", "--format", "json")[0])
        self.assertEqual(json.loads(output), {entry["channel"]: entry["events"] for entry in info["channels"]})

    def test_finds_its_ready_experiments_by_name_and_uses_quick_if_none_is_named(self):
        def flown(*arguments):
            return self.run_installed("fresco", "evaluate", "--policy", "aoi", "--format", "json", *arguments)[0]
        quick = flown()
        self.assertEqual(json.loads(quick)["total_aoi"], 3684)  # the README's
        for name in ("quick", "configs/quick.textproto"):
            self.assertEqual(flown("--config", name), quick)
        self.assertNotEqual(flown("--config", "tight_energy"), quick)
        _, errors = self.run_installed("fresco", "evaluate", "--policy", "aoi", "--config", "slow", expect=2)
        self.assertIn(f"{READY_EXPERIMENTS} in {self.prefix}/share/fresco/configs", errors)
        for program in ("fresco-learner", "fresco"):
            output, _ = self.run_installed(program, *(["train"] if program == "fresco" else []), "--help")
            self.assertIn("default: quick", " ".join(output.split()))

    def test_begins_the_default_experiment_with_its_own_learner(self):
        settings = ["--set", "schedule.episodes=20", "--set", "schedule.minimum_replay_size=100", "--set",
                    "run.optimum_limit_s=0"]
        output, _ = self.run_installed("fresco", "train", "--lcm-url", url(17343), *settings)
        self.assertIn("results go to runs/", output)
        self.assertIn("fresco evaluate --policy runs/", output)
        self.assertNotIn("tools/fresco", output)
        [folder] = (self.elsewhere / "runs").iterdir()
        self.assertTrue(json.loads((folder / "summary.json").read_text())["completed"])


if __name__ == "__main__":
    sys.exit(unittest.main())
