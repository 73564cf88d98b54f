"""`fresco fly`: what a receiver sees of a flight, against `fresco evaluate` of the same policy."""
import json
import signal
import struct
import sys
import unittest

from fresco_process import CI_CONFIG, FrescoTest, read_log, url, wait_until

# lcm/flight_t.lcm, written out once more: big-endian, behind eight bytes of fingerprint.
FLIGHT = struct.Struct(">QqqqiiiihhhffbhfqbI")
NAMES = ("fingerprint utime run_id config_hash sensor_count flight slot slots column row time_margin energy_margin_j "
         "remaining_energy_j move scheduled reward total_aoi outcome policy_size").split()
SCENARIO = struct.Struct(">Qqqqiiiiiiiidiiiiidddi")
SCENARIO_NAMES = ("fingerprint utime run_id config_hash sensor_count cell_count first_sensor total_sensors first_cell "
                  "total_cells columns rows cell_m start_column start_row stop_column stop_row slots slot_s "
                  "coverage_radius_m initial_energy_j maximum_aoi").split()
MOVES = ["north", "south", "east", "west", "hover"]


def decode_flight(data):
    message = dict(zip(NAMES, FLIGHT.unpack_from(data)))
    begin = FLIGHT.size + message["policy_size"]
    message["policy"] = data[FLIGHT.size:begin - 1].decode()
    message["aoi"] = list(struct.unpack_from(f">{message['sensor_count']}h", data, begin))
    return message


def decode_scenario(data):
    message = dict(zip(SCENARIO_NAMES, SCENARIO.unpack_from(data)))
    count = message["sensor_count"]
    numbers = struct.unpack_from(f">{3 * count}d", data, SCENARIO.size)
    message["sensors"] = list(zip(numbers[:count], numbers[count:2 * count], numbers[2 * count:]))
    return message


class Fly(FrescoTest):
    def setUp(self):
        super().setUp()
        self.log = self.folder / "lcm.log"

    def record(self, port):
        logger = self.start_command(["lcm-logger", "--lcm-url=" + url(port), "-f", self.log], bufsize=0)
        wait_until(self.log.exists, "lcm-logger")
        return logger

    def end(self, logger):
        logger.terminate()
        logger.wait(10)
        return list(read_log(self.log))

    def evaluate(self, *arguments):
        return json.loads(self.run_fresco("evaluate", *arguments, "--format", "json")[0])

    def check(self, messages, flown, policy):
        self.assertEqual([message["slot"] for message in messages], list(range(1, len(flown["flight"]) + 1)))
        for message, slot in zip(messages, flown["flight"]):
            self.assertEqual((message["column"], message["row"]), (slot["column"], slot["row"]))
            self.assertEqual((MOVES[message["move"]], message["scheduled"]), (slot["move"], slot["scheduled"]))
            self.assertEqual(message["aoi"], slot["aoi"])
            self.assertEqual((message["policy"], message["slots"]), (policy, 70))
        self.assertEqual([message["outcome"] for message in messages], [0] * (len(messages) - 1) + [1])
        self.assertEqual(messages[-1]["total_aoi"], flown["total_aoi"])
        self.assertAlmostEqual(messages[-1]["remaining_energy_j"], flown["residual_energy_j"], delta=0.01)
        self.assertEqual(len({message["run_id"] for message in messages}), 1)

    def test_publishes_the_flight_that_evaluate_prints_slot_by_slot(self):
        arguments = ["--config", CI_CONFIG, "--policy", "aoi"]
        logger = self.record(7850)
        output, errors = self.run_fresco("fly", *arguments, "--rate", 50, "--lcm-url", url(7850))
        events = self.end(logger)
        flown = self.evaluate(*arguments)
        messages = [decode_flight(data) for channel, data in events if channel == "FRESCO_FLIGHT"]
        self.check(messages, flown, "aoi")
        self.assertIn(f"total AoI {flown['total_aoi']}", output)
        self.assertIn(url(7850), errors)
        lasted_s = (messages[-1]["utime"] - messages[0]["utime"]) / 1e6
        self.assertGreater(lasted_s, 69 / 50 - 0.05)  # not faster than --rate says

    def test_says_over_which_field_before_the_flight_begins(self):
        logger = self.record(7851)
        self.run_fresco("fly", "--config", CI_CONFIG, "--policy", "distance", "--rate", 1000, "--lcm-url", url(7851))
        events = [(channel, data) for channel, data in self.end(logger) if channel.startswith("FRESCO")]
        self.assertEqual(events[0][0], "FRESCO_SCENARIO")
        field = decode_scenario(events[0][1])
        self.assertEqual(field["run_id"], decode_flight(events[1][1])["run_id"])
        self.assertEqual(field["sensors"], [(200, 175, 1), (25, 100, 1), (450, 475, 1)])
        self.assertEqual((field["columns"], field["rows"], field["cell_m"]), (20, 20, 25))
        self.assertEqual((field["start_column"], field["start_row"]), (10, 0))
        self.assertEqual((field["stop_column"], field["stop_row"], field["slots"]), (10, 19, 70))
        self.assertEqual((field["coverage_radius_m"], field["initial_energy_j"], field["maximum_aoi"]), (100, 22000, 0))

    def test_flies_a_trained_policy_again_and_again_until_it_is_told_to_end(self):
        self.train(7852, "run")
        logger = self.record(7852)
        policy = self.folder / "run"
        process = self.start("fly", "--policy", policy, "--rate", 500, "--loop", "--lcm-url", url(7852))
        wait_until(lambda: any(channel == "FRESCO_FLIGHT" and decode_flight(data)["flight"] > 1
                               for channel, data in read_log(self.log)), "a third flight")
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=10)
        self.assertEqual(process.returncode, 0, errors)
        messages = [decode_flight(data) for channel, data in self.end(logger) if channel == "FRESCO_FLIGHT"]
        flown = self.evaluate("--policy", policy)
        for flight in (0, 1):
            self.check([message for message in messages if message["flight"] == flight], flown, str(policy))

    def test_ends_at_once_with_status_1_where_it_is_interrupted(self):
        process = self.start("fly", "--config", CI_CONFIG, "--policy", "aoi", "--rate", 0.01, "--lcm-url", url(7853))
        self.assertIn("FRESCO_FLIGHT", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=5)
        self.assertEqual(process.returncode, 1, errors)

    def test_refuses_wrong_use(self):
        for arguments, word in [(["--policy", "none"], "none"), (["--policy", "aoi", "--rate", 0], "--rate"),
                                (["--policy", "aoi", "--lcm-url", "udpm://nowhere"], "udpm://nowhere")]:
            _, errors = self.run_fresco("fly", "--config", CI_CONFIG, *arguments, expect=2)
            self.assertIn(word, errors)


if __name__ == "__main__":
    sys.exit(unittest.main())
