"""`fresco evaluate`: every flight is checked against the paper's equations, written out once more here."""
import json
import math
import sys
import unittest

from fresco_process import CI_CONFIG, ROOT, FrescoTest

QUICK = ROOT / "configs" / "quick.textproto"
SENSORS_M = [(200, 175), (25, 100), (450, 475)]
MOVES = {"north": (0, 1), "south": (0, -1), "east": (1, 0), "west": (-1, 0), "hover": (0, 0)}
SLOTS = 70
HOVER_W, FLY_W = 219.82, 112.876  # Table I


class Evaluate(FrescoTest):
    def flight(self, *arguments):
        output, _ = self.run_fresco("evaluate", *arguments, "--format", "json")
        return json.loads(output)

    def check(self, flown, radius_m=100, sensors_m=SENSORS_M):
        """Eqs. (start pos), (stop pos), Dynamic-AoI and the sums, from the flight alone."""
        self.assertTrue(flown["arrived"])
        slots = flown["flight"]
        self.assertEqual([slot["slot"] for slot in slots], list(range(1, SLOTS + 1)))
        self.assertEqual((slots[0]["column"], slots[0]["row"]), (10, 0))
        self.assertEqual((slots[-1]["column"], slots[-1]["row"]), (10, 19))
        self.assertEqual(slots[0]["aoi"], [1, 1, 1])
        energy_j = 22000
        for now, after in zip(slots, slots[1:]):
            step = MOVES[now["move"]]
            self.assertEqual((after["column"], after["row"]), (now["column"] + step[0], now["row"] + step[1]))
            self.assertTrue(0 <= after["column"] < 20 and 0 <= after["row"] < 20)
            expected = [age + 1 for age in now["aoi"]]
            if now["scheduled"]:
                x, y = sensors_m[now["scheduled"] - 1]
                if math.hypot(25 * now["column"] - x, 25 * now["row"] - y) <= radius_m:
                    expected[now["scheduled"] - 1] = 1
            self.assertEqual(after["aoi"], expected)
            energy_j -= HOVER_W if now["move"] == "hover" else FLY_W
        total = sum(sum(slot["aoi"]) for slot in slots)
        self.assertEqual(flown["total_aoi"], total)
        self.assertAlmostEqual(flown["sum_aoi"], total / SLOTS, places=9)
        self.assertAlmostEqual(flown["average_aoi"], total / SLOTS / 3, places=9)
        self.assertAlmostEqual(flown["residual_energy_j"], energy_j, delta=0.1)

    def test_flies_both_baselines_by_the_equations(self):
        for policy in ("aoi", "distance"):
            self.check(self.flight("--config", QUICK, "--policy", policy))

    def test_flies_a_trained_run_by_the_equations(self):
        summary = self.train(17321, "run")
        for policy in (self.folder / "run", self.folder / "run" / "best.network"):
            flown = self.flight("--policy", policy)
            self.check(flown)
            self.assertEqual(flown["total_aoi"], summary["total_aoi"])
        baselines = [self.flight("--config", CI_CONFIG, "--policy", policy) for policy in ("aoi", "distance")]
        self.assertEqual([flown["total_aoi"] for flown in baselines],
                         [summary["baselines"][policy]["total_aoi"] for policy in ("aoi", "distance")])

    def test_flies_a_network_for_sets_over_any_number_of_sensors(self):
        config = self.folder / "sets.textproto"
        config.write_text("scenario { %s } agent { set_network {} safe_action_mask: true coverage_mask: true } "
                          "schedule { episodes: 30 minimum_replay_size: 500 inserts_per_update: 16 }" %
                          " ".join(f"sensor {{ x_m: {x} y_m: {y} }}" for x, y in SENSORS_M))
        summary = self.train(17326, "sets", config=config)
        flown = self.flight("--policy", self.folder / "sets")
        self.check(flown)
        self.assertEqual(flown["total_aoi"], summary["total_aoi"])
        other = self.folder / "other.textproto"
        other.write_text("scenario { random_sensors { count: 7 } } agent { set_network {} safe_action_mask: true }")
        flown = self.flight("--policy", self.folder / "sets", "--config", other)
        self.assertTrue(flown["arrived"])
        self.assertEqual(len(flown["flight"][0]["aoi"]), 7)

    def test_flies_the_exact_optimum_by_the_equations(self):
        fields = [(SENSORS_M, 25, 3733), (SENSORS_M, 50, 3459), (SENSORS_M, 100, 2789), (SENSORS_M, 150, 2097),
                  ([(125, 475), (100, 200), (75, 325)], 100, 985)]
        for sensors_m, radius_m, total_aoi in fields:
            config = self.folder / f"{total_aoi}.textproto"
            config.write_text("scenario { coverage_radius_m: %d %s }" % (
                radius_m, " ".join(f"sensor {{ x_m: {x} y_m: {y} }}" for x, y in sensors_m)))
            flown = self.flight("--config", config, "--policy", "optimal")
            self.check(flown, radius_m, sensors_m)
            self.assertTrue(flown["optimal"])
            self.assertEqual(flown["total_aoi"], total_aoi)
            self.assertEqual(flown["lower_bound_total_aoi"], total_aoi)

    def test_ends_the_search_for_the_optimum_at_its_limits_with_a_flight_and_a_bound(self):
        large = ["--config", QUICK, "--set", "scenario.coverage_radius_m=150", "--set", "scenario.slots=200", "--set",
                 "scenario.initial_energy_j=50000"]
        for limit in (["--time-limit-s", "0.01"], ["--memory-limit-mb", "1"]):
            flown = self.flight(*large, "--policy", "optimal", *limit)
            self.assertTrue(flown["arrived"])
            self.assertFalse(flown["optimal"])
            self.assertGreater(flown["lower_bound_total_aoi"], 0)
            self.assertLess(flown["lower_bound_total_aoi"], flown["total_aoi"])

    def test_names_a_policy_that_is_none(self):
        _, errors = self.run_fresco("evaluate", "--config", QUICK, "--policy", "best", expect=2)
        self.assertIn("best", errors)


if __name__ == "__main__":
    sys.exit(unittest.main())
