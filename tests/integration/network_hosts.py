"""Hosts of a test's own: network namespaces on a bridge of their own, whose incoming packets are lost as one likes."""
import json
import os
import shutil
import subprocess

ADDRESS = "10.86.0.{}/24"


def why_not():
    """Why there can be no hosts here; None where there can."""
    for program in ("ip", "nft"):
        if shutil.which(program) is None:
            return f"there is no `{program}` (Debian packages iproute2, nftables)"
    if os.geteuid() != 0:
        return "only root may make network namespaces"
    try:
        hosts = Hosts(1)
    except subprocess.CalledProcessError as error:
        return f"network namespaces with nftables can't be had here: {error.stderr.strip()}"
    hosts.remove()
    return None


def run(*command, text=None):
    return subprocess.run(command, input=text, check=True, capture_output=True, text=True).stdout


class Hosts:
    """`count` hosts, 0, 1, ..; nothing of it touches the host's own network."""

    def __init__(self, count):
        self._names = [f"fresco-{os.getpid()}-{i}" for i in range(count)]
        self._bridge = f"fresco-{os.getpid()}-bridge"
        self._made = []
        try:
            self._make()
        except BaseException:
            self.remove()
            raise

    def _make(self):
        for name in [self._bridge, *self._names]:
            run("ip", "netns", "add", name)
            self._made.append(name)
            run("ip", "-n", name, "link", "set", "lo", "up")
        run("ip", "-n", self._bridge, "link", "add", "bridge0", "type", "bridge", "mcast_snooping", "0")
        run("ip", "-n", self._bridge, "link", "set", "bridge0", "up")
        for i, name in enumerate(self._names):
            run("ip", "-n", name, "link", "add", "eth0", "type", "veth", "peer", "name", f"port{i}", "netns", self._bridge)
            run("ip", "-n", self._bridge, "link", "set", f"port{i}", "master", "bridge0", "up")
            run("ip", "-n", name, "address", "add", ADDRESS.format(i + 1), "dev", "eth0")
            run("ip", "-n", name, "link", "set", "eth0", "up")
            run("ip", "-n", name, "route", "add", "224.0.0.0/4", "dev", "eth0")
            self.lose(i, 0)

    def command(self, host, *command):
        """The command that runs it on the host."""
        return ("ip", "netns", "exec", self._names[host], *map(str, command))

    def lose(self, host, per_mille):
        """From now on, of the packets that come to the host."""
        drop = f"numgen random mod 1000 < {per_mille} counter drop" if per_mille else ""
        self._filter(self._names[host], "eth0", drop)

    def deafen(self, host):
        """Nothing reaches the host, until `lose`."""
        self._filter(self._names[host], "eth0", "counter drop")

    def cut_off(self, host):
        """Nothing reaches the host or leaves it, until `lose`, and `connect`."""
        self.deafen(host)
        self._filter(self._bridge, f"port{host}", "counter drop")

    def connect(self, host):
        self._filter(self._bridge, f"port{host}", "")
        self.lose(host, 0)

    def lost_packets(self, host):
        """Since the last call of `lose` or `cut_off`."""
        rules = json.loads(run("ip", "netns", "exec", self._names[host], "nft", "-j", "list", "ruleset"))["nftables"]
        return sum(expression["counter"]["packets"] for rule in rules for expression in rule.get("rule", {}).get("expr", ())
                   if "counter" in expression)

    @staticmethod
    def _filter(namespace, device, rule):
        run("ip", "netns", "exec", namespace, "nft", "-f", "-", text=f"""
            table netdev {device}
            delete table netdev {device}
            table netdev {device} {{
              chain incoming {{ type filter hook ingress device "{device}" priority 0; policy accept; {rule}
              }}
            }}""")

    def remove(self):
        for name in self._made:
            subprocess.run(["ip", "netns", "del", name], check=False, capture_output=True)
        self._made = []
