"""`fresco bench`: rows beside their references as text and as JSON, the check of recorded ratios, wrong use."""
import json
import shutil
import unittest

from fresco_process import BIN, FrescoTest

ENVIRONMENTS = ["environment_uav", "environment_cartpole", "environment_acrobot"]
SHORT = ["--seconds", 0.05]


class Bench(FrescoTest):
    def check(self, ratios, expect, **machine):
        """Checks ratios that were recorded on this machine, or on another one."""
        output, _ = self.run_fresco("bench", "--filter", "environment_acrobot", "--format", "json", *SHORT)
        recorded = {"machine": json.loads(output)["machine"] | machine,
                    "rows": [{"name": name, "ratio": ratio} for name, ratio in ratios.items()]}
        path = self.folder / "ratios.json"
        path.write_text(json.dumps(recorded))
        return self.run_fresco("bench", "--check", path, "--format", "json", *SHORT, expect=expect)

    def test_prints_each_row_beside_its_reference(self):
        output, progress = self.run_fresco("bench", "--filter", "^environment", "--format", "json", *SHORT)
        result = json.loads(output)
        self.assertEqual(set(result), {"machine", "commit", "rows", "absent"})
        self.assertEqual(set(result["machine"]), {"processor", "cores", "arithmetic", "compiler"})
        self.assertEqual([row["name"] for row in result["rows"]], ENVIRONMENTS)
        for row in result["rows"]:
            self.assertEqual(set(row), {"name", "value", "unit", "reference", "reference_value", "ratio"})
            self.assertEqual(row["unit"], "steps/s")
            self.assertGreater(row["value"], 0)
            self.assertAlmostEqual(row["ratio"], row["value"] / row["reference_value"], 12)
            self.assertIn(f"measuring {row['name']}", progress)
        text, _ = self.run_fresco("bench", "--filter", "cartpole", *SHORT)
        self.assertRegex(text, r"machine   .*\ncompiler  .*\ncommit    .*\n\nrow .*\nenvironment_cartpole +[0-9]+")

    def test_checks_the_rows_that_have_a_recorded_ratio(self):
        output, _ = self.check({"environment_cartpole": 1e-9}, expect=0)
        self.assertEqual([row["name"] for row in json.loads(output)["rows"]], ["environment_cartpole"])
        _, errors = self.check({"environment_cartpole": 1e9, "environment_uav": 1e-9}, expect=1)
        self.assertEqual(errors.count("environment_cartpole: the ratio is"), 2, "it was measured again")
        self.assertNotIn("environment_uav: the ratio is", errors)

    def test_checks_nothing_that_was_recorded_on_another_machine(self):
        for machine in ({"processor": "another"}, {"arithmetic": "another"}):
            output, errors = self.check({"environment_cartpole": 1e9}, expect=0, **machine)
            self.assertEqual(output, "")
            self.assertIn("no ratio is checked", errors)
            self.assertIn("another", errors)

    def test_refuses_wrong_use(self):
        for arguments, words in ((["--filter", "nothing"], ["--filter", "nothing", "environment_uav"]),
                                 (["--seconds", "0"], ["--seconds"]), (["--fliter", "a"], ["did you mean --filter?"]),
                                 (["--check", "/nowhere.json"], ["/nowhere.json"])):
            output, errors = self.run_fresco("bench", *arguments, expect=2)
            self.assertEqual(output, "")
            for word in words:
                self.assertIn(word, errors)
        _, errors = self.check({"enviroment_uav": 1}, expect=2)
        self.assertIn("did you mean environment_uav?", errors)

    def test_says_what_to_do_if_it_is_not_built(self):
        alone = shutil.copy(BIN / "fresco", self.folder)
        process = self.start_command([alone, "bench"])
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2)
        self.assertIn("tools/fresco bench installs", errors)


if __name__ == "__main__":
    unittest.main()
