#!/usr/bin/env python3
"""fresco doctor in network namespaces with one defect each: it says so, and the command that it names mends it."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest

import network_hosts
from fresco_process import BIN, FrescoTest, wait_until

FRESCO = pathlib.Path(os.environ["FRESCO_BIN"]) / "fresco"
HOSTS_URL = "udpm://239.255.76.67:7667?ttl=1"
ROUTE = "ip route add 224.0.0.0/4 dev lo"

# Takes the port for itself until its standard input ends.
TAKER = """
import socket, sys
taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
taken.bind(("0.0.0.0", 7667))
print("taken", flush=True)
sys.stdin.read()
"""


def in_namespace(script):
    """The standard output of a shell in a network namespace of its own, with loopback up."""
    command = ["unshare", "-Urn", "bash", "-c", "set -e; ip link set lo up; " + script]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120,
                            env={**os.environ, "FRESCO": str(FRESCO)})
    if result.returncode != 0:
        raise AssertionError(f"{script}: exit status {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout


def findings(report):
    return {finding["name"]: finding for finding in report["findings"]}


class Doctor(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            in_namespace("true")
        except AssertionError as error:
            raise unittest.SkipTest(f"needs network namespaces: {error}")

    def examine(self, before, status, options="", after=""):
        output = in_namespace(f"{before}; code=0; \"$FRESCO\" doctor --format json {options} || code=$?; "
                              f"test $code = {status}; {after}")
        return json.loads(output)

    def test_finds_a_sound_machine_sound(self):
        report = self.examine(ROUTE, 0)
        self.assertTrue(report["works"])
        self.assertEqual(findings(report)["delivery"]["health"], "good")
        self.assertRegex(findings(report)["delivery"]["found"], r"^0\.00 % of 10000 messages")
        self.assertIsNone(findings(report)["delivery"]["command"])

    def test_says_how_to_add_a_multicast_route(self):
        report = self.examine("true", 1)
        self.assertFalse(report["works"])
        route = findings(report)["multicast_route"]
        self.assertEqual(route["health"], "failure")
        self.assertNotIn("delivery", findings(report))
        self.assertTrue(self.examine(route["command"], 0)["works"])

    def test_says_which_port_is_free_if_another_program_has_this_one(self):
        take = f"{ROUTE}; coproc python3 -c '{TAKER}'; read -ru ${{COPROC[0]}}"
        port = findings(self.examine(take, 1))["port"]
        self.assertEqual(port["health"], "failure")
        url = re.search(r"--lcm-url '([^']+)'", port["command"]).group(1)
        self.assertIn(":7668", url)
        self.assertTrue(self.examine(take, 0, f"--lcm-url '{url}'")["works"])

    def test_says_which_rule_lets_multicast_through_a_firewall(self):
        if not shutil.which("nft"):
            self.skipTest("there is no `nft` (Debian package nftables)")
        drop = (f"{ROUTE}; nft add table inet filter; "
                "nft add chain inet filter input '{ type filter hook input priority 0; }'; "
                "nft add rule inet filter input udp dport 7667 drop")
        delivery = findings(self.examine(drop, 1))["delivery"]
        self.assertEqual(delivery["health"], "failure")
        self.assertTrue(self.examine(f"{drop}; {delivery['command']}", 0)["works"])

    def test_warns_of_small_buffers(self):
        url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000000000"
        report = self.examine(ROUTE, 0, f"--lcm-url '{url}'")
        buffer = findings(report)["receive_buffer"]
        self.assertEqual(buffer["health"], "warning")
        self.assertEqual(buffer["command"], "sysctl -w net.core.rmem_max=1000000000")

    def test_warns_of_another_run_and_leaves_it_alone(self):
        run = (f"{ROUTE}; folder=$(mktemp -d); \"$FRESCO\" train --config ci --set schedule.episodes=1000000 "
               "--set run.optimum_limit_s=0 --out $folder/run >$folder/log 2>&1 & run=$!; "
               "until [ -e $folder/run/learner.log ]; do kill -0 $run; done")
        end = "kill $run; wait $run || true; rm -rf $folder"
        report = self.examine(run, 0, after=end)
        self.assertEqual(findings(report)["other_traffic"]["health"], "warning")
        self.assertNotIn("delivery", findings(report))

    def test_refuses_a_folder_that_is_not_there(self):
        disk = findings(self.examine(ROUTE, 1, "--folder /nowhere/runs"))["disk"]
        self.assertEqual(disk["health"], "failure")
        self.assertEqual(disk["command"], "mkdir -p '/nowhere/runs'")

    def test_prints_text_for_people(self):
        text = in_namespace("code=0; \"$FRESCO\" doctor || code=$?; test $code = 1")
        self.assertIn(f"mend it: {ROUTE}\n", text)
        self.assertTrue(text.endswith("Training can't work on this machine.\n"))


class Hosts(FrescoTest):
    """fresco doctor --hosts, asking actors on other hosts."""

    def setUp(self):
        super().setUp()
        reason = network_hosts.why_not()
        if reason:
            self.skipTest(reason)
        self.hosts = network_hosts.Hosts(3)
        self.addCleanup(self.hosts.remove)

    def start_actor(self, host, *before):
        actor = self.start_command(self.hosts.command(host, *before, BIN / "fresco-actor", "--lcm-url", HOSTS_URL))
        wait_until(lambda: "waiting for a run" in actor.stderr.readline(), "the actor")
        return actor

    def ask(self, status=0):
        """What the doctor on host 0 found of each actor, by process id; 0: of none."""
        doctor = self.start_command(self.hosts.command(0, FRESCO, "doctor", "--hosts", "--format", "json", "--lcm-url", HOSTS_URL))
        output, errors = doctor.communicate(timeout=60)
        self.assertEqual(doctor.returncode, status, errors)
        hosts = [finding for finding in json.loads(output)["findings"] if finding["name"].startswith("host")]
        return {int(re.search(r"actor (\d+)|$", finding["found"])[1] or 0): finding for finding in hosts}

    def test_tells_losses_of_both_ways(self):
        sound, lossy = self.start_actor(1), self.start_actor(2)
        answers = self.ask()
        for actor in (sound, lossy):
            self.assertEqual(answers[actor.pid]["health"], "good", answers)
            self.assertRegex(answers[actor.pid]["found"],
                             r"of 2000 messages at 1?\d{3} a second 0\.\d\d % lost on the way there, 0\.\d\d % on the way back")
            self.assertRegex(answers[actor.pid]["found"], r"clock [+-]0\.00\d s")
        self.hosts.lose(2, 200)
        answers = self.ask()
        self.assertEqual(answers[sound.pid]["health"], "good", answers)
        self.assertEqual(answers[lossy.pid]["health"], "warning", answers)
        there, back = map(float, re.search(r"second (\S+) % lost on the way there, (\S+) % on", answers[lossy.pid]["found"]).groups())
        self.assertAlmostEqual(there, 20, delta=6)
        self.assertLess(back, 1)

    def test_tells_of_a_clock_that_is_wrong(self):
        library = next(pathlib.Path("/usr/lib").glob("*/faketime/libfaketime.so.1"), None)
        if library is None:
            self.skipTest("there is no libfaketime.so.1 (Debian package libfaketime)")
        self.start_actor(1, "env", f"LD_PRELOAD={library}", "FAKETIME=+5s")
        answer = next(iter(self.ask().values()))
        self.assertEqual(answer["health"], "warning", answer)
        self.assertRegex(answer["found"], r"clock \+(4\.9|5\.0)\d\d s")
        self.assertEqual(answer["command"], "timedatectl set-ntp true")

    def test_tells_of_a_host_that_does_not_hear_this_one(self):
        actor = self.start_actor(1)
        self.hosts.deafen(1)
        answer = self.ask()[actor.pid]
        self.assertEqual(answer["health"], "warning")
        self.assertIn("is heard, but answers none of 2000 messages", answer["found"])

    def test_says_what_to_start_if_nobody_answers(self):
        answer = self.ask()[0]
        self.assertEqual(answer["health"], "warning")
        self.assertIn("no actor answered", answer["found"])
        self.assertEqual(answer["command"], "fresco-actor --lcm-url 'udpm://239.255.76.67:7667?recv_buf_size=4194304&ttl=1'")


if __name__ == "__main__":
    unittest.main()
