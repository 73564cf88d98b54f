"""Reads LCM event logs; torn ones up to the tear, damaged ones without the damage."""
import heapq
import mmap
import struct

from . import message
from .transitions import WorldNames, rows_of

SYNC = b"\xED\xA1\xDA\x01"
HEADER = struct.Struct(">4sqqii")  # sync word, number, time, bytes of the channel's name, bytes of the message
# The limits of LCM's own programs.
MAXIMUM_CHANNEL_BYTES = 999
MAXIMUM_MESSAGE_BYTES = 1 << 28


class Event:
    """A message as it was received: `utime` (microseconds since the epoch), `channel`, `data` (bytes)."""
    __slots__ = ("utime", "channel", "data")

    def __init__(self, utime, channel, data):
        self.utime, self.channel, self.data = utime, channel, data

    @property
    def type(self):
        """The name of the message's type, e.g. "run_t"; None if it is not Fresco's."""
        return message.type_name(self.data)

    @property
    def message(self):
        """The decoded message, an object of fresco_log.fresco; None if it is damaged or not Fresco's."""
        return message.decode(self.data)


class EventLog:
    """The events of one or several logs, in the order of time. It can be read any number of times."""

    def __init__(self, *paths):
        if not paths:
            raise ValueError("expected the path of at least one log")
        self._files = [_LogFile(path) for path in paths]

    @property
    def unread_bytes(self):
        """The number of bytes that are no whole event: damaged ones, and an event that is torn at the end. Known after
        all events were read."""
        return sum(file.unread_bytes for file in self._files)

    def __iter__(self):
        return heapq.merge(*(file.events() for file in self._files), key=lambda event: event.utime)

    def messages(self, *types):
        """The sound messages of these types, e.g. "learner_status_t"; without types, all of Fresco's."""
        for event in self:
            if not types or event.type in types:
                decoded = event.message
                if decoded is not None:
                    yield decoded

    def world_names(self):
        """The WorldNames of each run that tells them, by its run_id."""
        names = {}
        for world in self.messages("world_t"):
            names.setdefault(world.run_id, WorldNames()).add(world)
        return {run_id: known for run_id, known in names.items() if known.is_complete}

    def transitions(self):
        """A dictionary for each transition, with the columns of `fresco log export`."""
        names = self.world_names()
        for transitions in self.messages("transitions_t"):
            yield from rows_of(transitions, names.get(transitions.run_id))


class _LogFile:
    def __init__(self, path):
        self.path, self.unread_bytes = path, 0
        with open(path, "rb") as file:
            beginning = file.read(len(SYNC))
        if len(beginning) == len(SYNC) and beginning != SYNC:
            raise ValueError(f"{path}: expected an LCM event log, as lcm-logger and fresco log record write them; "
                             f"found a file that does not begin with the sync word ED A1 DA 01")

    def events(self):
        with open(self.path, "rb") as file:
            self.unread_bytes = file.seek(0, 2)
            if self.unread_bytes == 0:
                return
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                yield from _Events(data, self)


class _Events:
    """The events in the bytes of a file, found as logs/event_log_reader.cc finds them."""

    def __init__(self, data, file):
        self.data, self.file = data, file
        self.whole_event = -1  # where the last search found one, so that no byte is searched twice

    def __iter__(self):
        data, size = self.data, len(self.data)
        position = read = 0
        while position + HEADER.size <= size:
            end = self.end_of_event(position)
            if end is not None and end <= size:
                if not self.swallows_another(position, end):
                    _, _, utime, channel_bytes, _ = HEADER.unpack_from(data, position)
                    begin = position + HEADER.size
                    channel = data[begin:begin + channel_bytes].decode(errors="replace")
                    yield Event(utime, channel, data[begin + channel_bytes:end])
                    read += end - position
                    position = end
                    continue
            elif end is not None and not self.has_whole_event(position, size):
                break  # torn
            found = data.find(SYNC, position + 1)
            position = size if found < 0 else found
        self.file.unread_bytes = size - read

    def end_of_event(self, position):
        """Behind the event that begins here, if one can begin here."""
        sync, _, _, channel_bytes, message_bytes = HEADER.unpack_from(self.data, position)
        is_possible = (sync == SYNC and 0 < channel_bytes <= MAXIMUM_CHANNEL_BYTES
                       and 0 <= message_bytes <= MAXIMUM_MESSAGE_BYTES)
        return position + HEADER.size + channel_bytes + message_bytes if is_possible else None

    def swallows_another(self, position, end):
        """Whether the event's length is damaged: no event begins behind its end, but one begins inside it."""
        follows = self.data[end:end + len(SYNC)]
        return len(follows) == len(SYNC) and follows != SYNC and self.has_whole_event(position, end)

    def has_whole_event(self, position, end):
        """Whether a whole event begins behind `position` and before `end`. Behind it there must be another one or the
        end of the file, since a message may contain the bytes of a sync word."""
        if self.whole_event <= position:
            found = self.data.find(SYNC, position + len(SYNC), end + len(SYNC) - 1)
            while found >= 0 and not self.is_whole_event(found):
                found = self.data.find(SYNC, found + len(SYNC), end + len(SYNC) - 1)
            if found < 0:
                return False
            self.whole_event = found
        return self.whole_event < end

    def is_whole_event(self, position):
        if position + HEADER.size > len(self.data):
            return False
        end = self.end_of_event(position)
        return end is not None and (end == len(self.data) or self.data[end:end + len(SYNC)] == SYNC)
