"""Wrong use ends with exit status 2 and a word on what is wrong, where, and what is allowed."""
import sys
import unittest

from fresco_process import CI_CONFIG, FrescoTest

CONFIGS = [
    ("scenario { slotz: 70 }", ["slotz"]),
    ("scenario { slots: 0 }", ["scenario.slots", "0", "allowed"]),
    ("agent { batch_size: 0 }", ["agent.batch_size", "0", "allowed"]),
    ("agent { discount: nan }", ["agent.discount", "nan", "allowed"]),
    ("scenario { sensor { x_m: 1 y_m: 1 } random_sensors { count: 2 } }", ["sensor", "random_sensors"]),
    ("scenario { slots: 10 }", ["slots", "10"]),
    ("scenario { initial_energy_j: 100 }", ["initial_energy_j", "100"]),
    ("scenario { coverage_radius_m: 100 transmit_power_w: 1 }", ["coverage_radius_m", "transmit_power_w"]),
    ("scenario { transmit_power_w: 1e-9 }", ["1e-09"]),
    ("run { channel_prefix: \"a b\" }", ["run.channel_prefix", "a b", "allowed"]),
]
ARGUMENTS = [
    (["--lcm-url", "udpm//239.255.76.67:7667"], ["udpm"]),
    (["--lcm-url", "udpm://10.0.0.1:7667"], ["10.0.0.1"]),
    (["--lcm-url", "udpm://239.255.76.67:7667?tll=0"], ["tll"]),
    (["--lcm-url", "tcpq://127.0.0.1:17340"], ["tcpq", "TCPService"]),
    (["--actors", "-1"], ["--actors"]),
    (["--set", "agent.batchsize=3"], ["batchsize", "batch_size"]),
    (["--set", "agent.batch_size=many"], ["many"]),
    (["--set", "agent"], ["path=value"]),
    (["--config", "/nowhere.textproto"], ["/nowhere.textproto"]),
    (["--frobnicate"], ["frobnicate"]),
]


class BadInput(FrescoTest):
    def refuse(self, words, *arguments):
        with self.subTest(arguments=arguments):
            output, errors = self.run_fresco("train", "--out", self.folder / "out", *arguments, expect=2)
            for word in words:
                self.assertIn(word, errors + output)

    def test_in_a_configuration_is_named_with_file_field_value_and_what_is_allowed(self):
        for number, (text, words) in enumerate(CONFIGS):
            path = self.folder / f"bad-{number}.textproto"
            path.write_text(text)
            self.refuse(words + [path.name], "--config", path)

    def test_on_the_command_line_is_named(self):
        for arguments, words in ARGUMENTS:
            base = [] if "--config" in arguments else ["--config", CI_CONFIG]
            self.refuse(words, *base, *arguments)

    def test_never_overwrites_another_runs_results(self):
        (self.folder / "out").mkdir()
        (self.folder / "out" / "summary.json").write_text("{}")
        self.refuse(["new folder"], "--config", CI_CONFIG)
        self.assertEqual((self.folder / "out" / "summary.json").read_text(), "{}")


if __name__ == "__main__":
    sys.exit(unittest.main())
