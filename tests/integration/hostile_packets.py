"""LCM's packets as raw UDP: recording those of a run, making hostile ones of them, sending them by the ten thousand."""
import collections
import itertools
import multiprocessing
import random
import socket
import struct
import threading
import time

from fresco_process import PATIENCE

GROUP = "239.255.76.67"
SMALL_MESSAGE = 0x4C433032  # LCM's magic number: this packet is a whole message
FRAGMENT = 0x4C433033
IDENTITY = struct.Struct(">QqqQ")  # fingerprint of the type, utime, run_id, config_hash; then the counts
Identity = collections.namedtuple("Identity", "fingerprint utime run_id config_hash")
CHANNELS = ("RUN", "ORDERS", "TRANSITIONS", "WEIGHTS_CURRENT", "WEIGHTS_TARGET", "ACTOR_STATUS", "LEARNER_STATUS")


def _crc_table():
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ (0x82F63B78 if byte & 1 else 0)
        yield byte


CRC_TABLE = list(_crc_table())


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = (crc >> 8) ^ CRC_TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def packet(channel, content):
    return struct.pack(">II", SMALL_MESSAGE, 0) + channel.encode() + b"\0" + content


def parts(datagram):
    """Channel and content; an empty channel where it is not a small message."""
    if len(datagram) < 9 or struct.unpack_from(">I", datagram)[0] != SMALL_MESSAGE:
        return "", b""
    channel, _, content = datagram[8:].partition(b"\0")
    return channel.decode(errors="replace"), content


def identity_of(datagram):
    return Identity(*IDENTITY.unpack_from(parts(datagram)[1]))


def with_trailer(encoding):
    return encoding + struct.pack(">I", crc32c(encoding))


class Recorder(threading.Thread):
    """Keeps the datagrams on a port, as they came."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.datagrams = []
        self._ended = threading.Event()
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        self._socket.bind((GROUP, port))
        membership = struct.pack("4sL", socket.inet_aton(GROUP), socket.INADDR_ANY)
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        self._socket.settimeout(0.1)
        self.start()

    def run(self):
        while not self._ended.is_set():
            try:
                self.datagrams.append(self._socket.recv(65536))
            except TimeoutError:
                pass

    def end(self):
        self._ended.set()
        self.join()
        self._socket.close()
        return self.datagrams


def fragment(sequence, message_bytes, offset, number, count, rest):
    """A part of a message: the one of number 0 has the channel, with its zero, in front of its data."""
    return struct.pack(">IIIIHH", FRAGMENT, sequence, message_bytes, offset, number, count) + rest


def hostile_fragments():
    """(kind, datagram) pairs: fragments that lie about their place, their message or each other. All are of the channel
    ATTACK, on which nobody must hear anything, however often and in whichever order one sender sends them."""
    begin = b"ATTACK\0"
    messages = {
        "behind the end": [[(64, offset, number, count, begin * (number == 0) + bytes(20))] for offset in
                           (0xFFFFFFF0, 0x7FFFFFFF, 1000) for number, count in ((0, 1), (0, 2), (1, 2))],
        "too large": [[(size, 0, 0, 2, begin + bytes(1000))] for size in (1 << 28, (1 << 28) + 1, 1 << 31, 0xFFFFFFFF)],
        "impossible number": [[(64, 0, 0, 0, begin + bytes(64))], [(64, 0, 2, 2, bytes(64))], [(64, 0, 65535, 1, bytes(64))]],
        "duplicated": [[(96, 0, 0, 3, begin + bytes(32))] * 3, [(64, 0, 0, 2, begin + bytes(32))] * 2],
        "overlapping": [[(100, 0, 0, 2, begin + bytes(60)), (100, 40, 1, 2, bytes(60))],
                        [(100, 40, 1, 2, bytes(60)), (100, 0, 0, 2, begin + bytes(60))]],
        "with a hole": [[(100, 0, 0, 2, begin + bytes(40)), (100, 60, 1, 2, bytes(40))], [(64, 0, 0, 1, begin)]],
        "contradictory": [[(100, 0, 0, 2, begin + bytes(50)), (200, 50, 1, 2, bytes(150))],
                          [(100, 0, 0, 2, begin + bytes(50)), (100, 50, 1, 3, bytes(50))],
                          [(100, 0, 0, 3, begin + bytes(50)), (100, 0, 0, 3, begin + b"x" * 50)]],
        "without a channel": [[(64, 0, 0, 1, b"ATTACK")], [(64, 0, 0, 1, b"")], [(64, 0, 0, 1, b"ATTACK" * 11 + bytes(65))]],
    }
    sequence = itertools.count()
    pairs = []
    for kind, fragments_of in messages.items():
        for fragments in fragments_of:
            number = next(sequence)
            pairs += [(kind, fragment(number, *fields)) for fields in fragments]
    return pairs + [("cut short", fragment(next(sequence), 64, 0, 0, 1, b"")[:size]) for size in range(4, 20)]


def hostile_packets(recorded, run_id, seed=1):
    """(kind, datagram) pairs from the packets of an earlier run, against the run `run_id`: every kind in turn."""
    draw = random.Random(seed)
    by_channel = {name: [content for channel, content in map(parts, recorded) if channel == "FRESCO_" + name]
                  for name in CHANNELS}

    def real():
        name = draw.choice([name for name in CHANNELS if by_channel[name]])
        return "FRESCO_" + name, draw.choice(by_channel[name])

    def changed(run=None, config=0, counts=(), trailer=True):
        channel, content = real()
        fingerprint, utime, old_run, config_hash = IDENTITY.unpack_from(content)
        encoding = bytearray(content[:-4])
        IDENTITY.pack_into(encoding, 0, fingerprint, utime, old_run if run is None else run, config_hash ^ config)
        if counts:
            struct.pack_into(">i", encoding, IDENTITY.size, draw.choice(counts))
        return packet(channel, with_trailer(bytes(encoding)) if trailer else bytes(encoding) + content[-4:])

    def truncated():
        channel, content = real()
        return packet(channel, content[:draw.randrange(len(content))])

    def first_fragment(offset):
        channel = b"FRESCO_" + draw.choice(CHANNELS).encode() + b"\0"
        return fragment(draw.randrange(9), 1_000_000, offset, 0, 900, channel + draw.randbytes(1200))

    absurd = (500_000_000, -1, 2**31 - 1, -2**31)
    kinds = {
        "no LCM packet": lambda: draw.randbytes(draw.randrange(1, 1400)),
        "random content": lambda: packet("FRESCO_" + draw.choice(CHANNELS), draw.randbytes(draw.randrange(1340))),
        "cut short": truncated,
        "absurd count, CRC holds": lambda: changed(run=run_id, counts=absurd),
        "absurd count, CRC does not": lambda: changed(run=run_id, counts=absurd, trailer=False),
        "random channel": lambda: packet(f"{draw.randrange(2**64):X}", b""),
        "other channel": lambda: packet(draw.choice(("OTHER", "FRESCO_", "FRESCO_RUNS", "F" * 90)), draw.randbytes(99)),
        "a channel of zeros": lambda: packet("", bytes(80)),  # what LCM reads behind the end of the next one
        "a channel without its end": lambda: packet("FRESCO_" + draw.choice(CHANNELS), b"")[:-1],
        "fragment": lambda: first_fragment(0),
        "fragment behind its message's end": lambda: first_fragment(0xFFFFFFF0),
        "other run": lambda: changed(),
        "many other runs": lambda: changed(run=draw.randrange(1, 2**62)),
        "other configuration": lambda: changed(run=run_id, config=draw.randrange(1, 2**32)),
    }
    made = [(kind, make()) for _ in range(150) for kind, make in kinds.items()]
    oversized = [("60 KB", packet("FRESCO_" + name, draw.randbytes(60_000))) for name in CHANNELS]
    step = len(made) // len(oversized)
    for i, entry in enumerate(oversized):
        made.insert(i * step, entry)
    return made


def _send(port, packets, packets_per_s, stop, sent):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
        # Not connected: where multicast is routed over the loopback device, nothing of a connected socket arrives.
        begin = time.monotonic()
        for count, (_, datagram) in enumerate(itertools.cycle(packets), 1):
            try:
                sender.sendto(datagram, (GROUP, port))
            except OSError:  # no room at the moment
                pass
            if count % 64 == 0:
                sent.value = count
                if stop.is_set():
                    return
                time.sleep(max(0, begin + count / packets_per_s - time.monotonic()))


class Flood:
    """Sends (kind, datagram) pairs round and round, from a process of its own, until it is ended; so much slower as the
    programs that receive them are with a sanitizer: two cores do nothing else than drop packets otherwise."""

    def __init__(self, port, packets, packets_per_s):
        self._packets = packets
        self._stop, self._sent = multiprocessing.Event(), multiprocessing.Value("q", 0)
        self._process = multiprocessing.Process(
            target=_send, args=(port, packets, packets_per_s / PATIENCE, self._stop, self._sent), daemon=True)
        self._begin = time.monotonic()
        self._process.start()

    def end(self):
        """Returns packets sent by kind, and packets a second."""
        self._stop.set()
        self._process.join()
        seconds = time.monotonic() - self._begin
        counts = {}
        for place, (kind, _) in enumerate(self._packets):
            rounds, rest = divmod(self._sent.value, len(self._packets))
            counts[kind] = counts.get(kind, 0) + rounds + (place < rest)
        return counts, self._sent.value / seconds
