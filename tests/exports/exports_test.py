#!/usr/bin/env python3
"""Policies that left Fresco, run by others on 10,000 states of every kind of world: the header, compiled by itself,
has the same bits; the ONNX model takes the same actions in onnxruntime; the CSV has every parameter."""
import array
import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ORT = "onnxruntime-web@1.20.1"

# std::fma is a function of its own for processors without the instruction.
FMA = ["-mfma", "-ffp-contract=off"] if " fma " in pathlib.Path("/proc/cpuinfo").read_text() else []

DRIVER = """
#include "policy.h"
#include <cstdio>
#include <vector>
int main() {
  using namespace exported;
  std::vector<float> state(kStateSize), values(kActions);
  bool mask[kActions];
  while (std::fread(state.data(), sizeof(float), kStateSize, stdin) == kStateSize) {
#ifdef MASK_IS_INPUT
    if (std::fread(mask, 1, kActions, stdin) != kActions) return 1;
    Values(state.data(), values.data());
    const int action = Act(state.data(), mask);
#else
    Values(state.data(), values.data(), mask);
    const int action = Act(state.data());
#endif
    std::fwrite(&action, sizeof action, 1, stdout);
    std::fwrite(mask, 1, kActions, stdout);
    std::fwrite(values.data(), sizeof(float), kActions, stdout);
  }
}
"""


def read(path, kind):
    numbers = array.array(kind)
    numbers.frombytes(path.read_bytes())
    return numbers


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="fresco_exports_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        subprocess.run([pathlib.Path(os.environ["FRESCO_BIN"]) / "write_policies", cls.folder / "policies"], check=True)

    def for_each_policy(self, check):
        for folder in sorted(path.parent for path in (self.folder / "policies").glob("*/policy.onnx")):
            with self.subTest(folder.name):
                check(folder, json.loads((folder / "sizes.json").read_text()))

    def test_header_has_the_same_bits(self):
        def check(folder, sizes):
            (folder / "driver.cc").write_text(DRIVER)
            subprocess.run(["g++", "-std=c++17", "-O2", *FMA, "-Wall", "-Wextra", "-Werror", "-pedantic",
                            *(["-DMASK_IS_INPUT"] if sizes["mask_is_input"] else []), "driver.cc", "-o", "driver"],
                           cwd=folder, check=True)
            actions = (folder / "actions").read_bytes()
            masks = (folder / "masks").read_bytes()
            states = (folder / "states").read_bytes()
            if sizes["mask_is_input"]:
                states = b"".join(
                    states[4 * sizes["fields"] * i:4 * sizes["fields"] * (i + 1)]
                    + masks[sizes["actions"] * i:sizes["actions"] * (i + 1)] for i in range(sizes["states"]))
            found = subprocess.run([folder / "driver"], input=states, capture_output=True, check=True).stdout
            values = (folder / "values").read_bytes()
            count = sizes["actions"]
            expected = b"".join(
                actions[4 * i:4 * i + 4] + masks[count * i:count * (i + 1)] + values[4 * count * i:4 * count * (i + 1)]
                for i in range(sizes["states"]))
            self.assertEqual(len(found), len(expected))
            self.assertTrue(found == expected, "other bits")

        self.for_each_policy(check)

    def test_onnxruntime_takes_the_same_actions(self):
        if not shutil.which("npm"):
            self.skipTest("onnxruntime is installed by npm, which is not there")
        installed = subprocess.run(["npm", "install", "--no-audit", "--no-fund", "--fetch-retries=1", "--fetch-timeout=20000",
                                    "--prefix", self.folder, ORT], capture_output=True, text=True)
        if installed.returncode != 0:
            self.skipTest(f"npm can't install {ORT}: {installed.stderr.strip()}")
        runtime = self.folder / "node_modules/onnxruntime-web/dist/ort.node.min.mjs"
        def check(folder, sizes):
            output = subprocess.run(["node", HERE / "run_onnx.mjs", runtime, folder / "policy.onnx", folder / "states",
                                     str(sizes["fields"]), *([folder / "masks"] if sizes["mask_is_input"] else [])],
                                    capture_output=True, check=True, text=True).stdout
            found = json.loads(output)
            self.assertEqual(found["mask"], None if sizes["mask_is_input"] else list((folder / "masks").read_bytes()))
            values = read(folder / "values", "f")
            scale = max(abs(value) for value in values)
            self.assertLess(max(abs(a - b) for a, b in zip(found["values"], values)), 1e-5 * scale)
            actions = read(folder / "actions", "i")
            self.assertEqual(len(found["action"]), len(actions))
            for i, (a, b) in enumerate(zip(found["action"], actions)):
                if a != b:  # only if both are equally good, but for rounding
                    first = i * sizes["actions"]
                    self.assertAlmostEqual(values[first + a], values[first + b], delta=1e-6 * scale)

        self.for_each_policy(check)

    def test_csv_has_every_parameter(self):
        def check(folder, sizes):
            with open(folder / "policy.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual(len(rows), sizes["parameters"])
            self.assertEqual(len({(row["chain"], row["layer"], row["output"], row["input"]) for row in rows}), len(rows))
            self.assertTrue(all(abs(float(row["value"])) < 100 for row in rows))

        self.for_each_policy(check)

    def test_command_writes_a_run_and_refuses_the_rest(self):
        fresco = pathlib.Path(os.environ["FRESCO_BIN"]) / "fresco"

        def export(*arguments, expect=0):
            result = subprocess.run([fresco, "export", *map(str, arguments)], capture_output=True, text=True)
            self.assertEqual(result.returncode, expect, result.stderr)
            return result.stdout + result.stderr

        network = self.folder / "policies/fields/policy.network"
        out = self.folder / "out"
        for kind in ("onnx", "cpp", "csv"):
            self.assertIn(f"{out}: {kind} (", export("--policy", network, "--format", kind, "--out", out, "--name", "exported"))
            written = network.parent / {"onnx": "policy.onnx", "cpp": "policy.h", "csv": "policy.csv"}[kind]
            self.assertEqual(out.read_bytes(), written.read_bytes())
        out.unlink()
        self.assertIn("expected a trained policy; found aoi", export("--policy", "aoi", "--format", "csv", "--out", out, expect=2))
        self.assertIn("'a b' is no namespace",
                      export("--policy", network, "--format", "cpp", "--name", "a b", "--out", out, expect=2))
        city = ["--policy", self.folder / "policies/city/policy.network", "--out", out]
        self.assertIn("give --config of one field over the map", export(*city, "--format", "onnx", expect=2))
        self.assertFalse(out.exists())
        export(*city, "--format", "csv")


if __name__ == "__main__":
    unittest.main()
