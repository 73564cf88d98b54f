"""`fresco figures --quick`: real runs over real LCM; every number holds together, and a stopped study goes on."""
import csv
import json
import os
import signal
import struct
import sys
import unittest
import xml.etree.ElementTree

from fresco_process import CI_CONFIG, FrescoTest, processes_with, url, wait_until

FIGURES = ["radius", "sensors", "energy", "energy_dear_flight", "learning_curve", "flight_dqn", "flight_optimal",
           "flight_aoi", "flight_distance"]


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Figures(FrescoTest):
    def command(self, port, *arguments):
        """With the exact optimum beside every point, also where a sanitizer makes the search slow."""
        return ("figures", "--quick", "--config", CI_CONFIG, "--lcm-url", url(port), "--out", self.folder / "study",
                "--set", "run.optimum_limit_s=600", *arguments)

    def figures(self, port, *arguments, expect=0, **options):
        return self.run_fresco(*self.command(port, *arguments), expect=expect, **options)

    def check_deployment_figure(self, name, column, values):
        rows = rows_of(self.folder / "study" / f"{name}.csv")
        self.assertEqual([row[column] for row in rows], values)
        for row in rows:
            self.assertEqual(row["deployments"], "2")
            average = {policy: float(row[f"{policy}_average_aoi"]) for policy in ("dqn", "aoi", "distance", "optimal")}
            self.assertLessEqual(average["optimal"], min(average.values()))
            self.assertGreater(float(row["dqn_half_width"]), 0)

    def check_runs(self):
        runs = rows_of(self.folder / "study" / "runs.csv")
        self.assertEqual(len({run["run"] for run in runs}), len(runs))
        for run in runs:
            optimum = int(run["optimal_total_aoi"])
            for policy in ("dqn", "aoi", "distance"):
                self.assertLessEqual(optimum, int(run[f"{policy}_total_aoi"]), run)
            gap = 100 * (int(run["dqn_total_aoi"]) / optimum - 1)
            self.assertAlmostEqual(float(run["gap_percent"]), gap, places=6)
        return runs

    def check_pictures(self):
        for figure in FIGURES:
            picture = (self.folder / "study" / f"{figure}.png").read_bytes()
            self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
            self.assertGreaterEqual(struct.unpack(">I", picture[16:20])[0], 1000)
            xml.etree.ElementTree.parse(self.folder / "study" / f"{figure}.svg")

    def check_flight(self, name, total_aoi):
        slots = rows_of(self.folder / "study" / f"{name}.csv")
        self.assertEqual((slots[-1]["slot"], slots[-1]["column"], slots[-1]["row"]), ("70", "10", "19"))
        self.assertEqual(sum(int(slot[f"aoi_{n}"]) for slot in slots for n in (1, 2, 3)), total_aoi)

    def test_stops_goes_on_and_writes_every_figure(self):
        process = self.start(*self.command(17331, "--parallel", 2))
        runs_folder = self.folder / "study" / "runs"
        wait_until(lambda: len(list(runs_folder.glob("*/checkpoints"))) >= 3, "a first complete run, and a third")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("continues the study", errors)
        self.assertEqual(processes_with(":17331"), [])
        complete = {path: path.stat().st_mtime_ns for path in runs_folder.glob("*/summary.json")
                    if '"completed": true' in path.read_text()
                    and '"optimum_search": "stopped"' not in path.read_text()}
        interrupted = {path.parent for path in runs_folder.glob("*/checkpoints")} - {path.parent for path in complete}
        self.assertTrue(complete)
        self.assertTrue(interrupted)
        self.figures(17331)
        for folder in interrupted:
            self.assertEqual(json.loads((folder / "summary.json").read_text())["resumptions"], 1, folder)
        for path, written in complete.items():
            self.assertEqual(path.stat().st_mtime_ns, written, "a complete run was flown again")
        self.check_deployment_figure("radius", "radius_cells", ["2", "4"])
        self.check_deployment_figure("sensors", "sensors", ["1", "2"])
        runs = self.check_runs()
        self.check_pictures()
        field = next(run for run in runs if run["run"] == "field")
        self.check_flight("flight_dqn", int(field["dqn_total_aoi"]))
        self.check_flight("flight_optimal", 2789)
        page = (self.folder / "study" / "report.html").read_text()
        for word in ("Effect of the coverage radius", "exact optimum", "distance-based"):
            self.assertIn(word, page)
        # The figures are made again from the complete runs; where gnuplot fails all the numbers are.
        for path in (self.folder / "study").glob("*.*"):
            path.unlink()
        gnuplot = self.folder / "gnuplot"
        gnuplot.write_text("#!/bin/sh\necho out of ink >&2\nexit 1\n")
        gnuplot.chmod(0o700)
        _, errors = self.figures(17331, expect=1, env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
        self.assertIn("out of ink", errors)
        self.check_runs()
        self.assertTrue((self.folder / "study" / "report.html").exists())

    def test_refuses_the_folder_of_another_study(self):
        self.figures(17332, "--deployments", 1, "--set", "schedule.episodes=20", "--set",
                     "schedule.minimum_replay_size=100")
        _, errors = self.figures(17332, "--deployments", 1, "--set", "schedule.episodes=21", expect=2)
        self.assertIn("new folder", errors)


if __name__ == "__main__":
    sys.exit(unittest.main())
