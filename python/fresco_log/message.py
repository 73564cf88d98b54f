"""Decodes Fresco's messages. Bytes that are damaged or hostile cost no more time than others."""
import array
import io
import struct
import sys

from .message_types import MESSAGE_TYPES

MAXIMUM_ENCODED_BYTES = 1302
CRC_BYTES = 4
AUTHENTICATION_BYTES = 32  # behind the CRC in runs with a --key-file
FINGERPRINT_BYTES = 8
IDENTITY_BYTES = 24  # utime, run_id, config_hash
# Fields that texts and files show in hexadecimal digits, and how many.
HEXADECIMAL_DIGITS = {"run_id": 16, "config_hash": 8, "crc32c": 8, "arithmetic_fingerprint": 8}

_BY_FINGERPRINT = {entry[0]._get_packed_fingerprint(): entry for entry in MESSAGE_TYPES}


def _crc32c_of_byte(value):
    for _ in range(8):
        value = value >> 1 ^ (0x82F63B78 if value & 1 else 0)
    return value


_ONE_BYTE = [_crc32c_of_byte(value) for value in range(1 << 8)]
_TWO_BYTES = [first >> 8 ^ _ONE_BYTE[first & 0xFF]
              for first in (value >> 8 ^ _ONE_BYTE[value & 0xFF] for value in range(1 << 16))]


def _crc32c(data):
    crc = 0xFFFFFFFF
    pairs = array.array("H", data[:len(data) & ~1])
    if sys.byteorder == "big":
        pairs.byteswap()
    for pair in pairs:
        crc = crc >> 16 ^ _TWO_BYTES[(crc ^ pair) & 0xFFFF]
    if len(data) % 2:
        crc = crc >> 8 ^ _ONE_BYTE[(crc ^ data[-1]) & 0xFF]
    return crc ^ 0xFFFFFFFF


def type_name(data):
    """The name of the type that the bytes begin like, e.g. "run_t"; None if they are not Fresco's."""
    entry = _BY_FINGERPRINT.get(bytes(data[:FINGERPRINT_BYTES]))
    return entry[0].__name__ if entry else None


def decode(data):
    """The message, an object of fresco_log.fresco; None if the bytes are damaged or not Fresco's."""
    entry = _BY_FINGERPRINT.get(bytes(data[:FINGERPRINT_BYTES]))
    if entry is None:
        return None
    for trailer_bytes in (CRC_BYTES, CRC_BYTES + AUTHENTICATION_BYTES):
        encoding = data[:-trailer_bytes]
        crc = data[len(encoding):len(encoding) + CRC_BYTES]
        if len(crc) == CRC_BYTES and struct.unpack(">I", crc)[0] == _crc32c(encoding):
            return _decode_encoding(encoding, *entry)
    return None


def _decode_encoding(encoding, message_type, fixed_bytes, texts, count_maxima):
    """Checks every count and text before the type's own decoder trusts them."""
    if not fixed_bytes <= len(encoding) <= MAXIMUM_ENCODED_BYTES:
        return None
    counts = struct.unpack_from(f">{len(count_maxima)}i", encoding, FINGERPRINT_BYTES + IDENTITY_BYTES)
    if not all(0 <= count <= maximum for count, maximum in zip(counts, count_maxima)):
        return None
    offset = fixed_bytes
    for _ in range(texts):
        if len(encoding) < offset + 4:
            return None
        end = offset + 4 + struct.unpack_from(">I", encoding, offset)[0]
        if encoding.find(b"\0", offset + 4, end) != end - 1:  # one NUL, at the end
            return None
        offset = end
    content = _Content(encoding)
    try:
        message = message_type.decode(content)
    except ValueError:
        return None
    return message if content.tell() == len(encoding) else None


class _Content(io.BytesIO):
    """The bytes of a message. The types' decoders do not notice if bytes are missing."""

    def read(self, size):
        content = super().read(size)
        if len(content) < size:
            raise ValueError("the message ends too early")
        return content


def as_dict(message):
    """The fields of a message as `fresco log cat` shows them, but without the names that FRESCO_WORLD gives."""
    result = {}
    for name in message.__slots__:
        value = getattr(message, name)
        if name in HEXADECIMAL_DIGITS:
            value = f"{value & (1 << 64) - 1:0{HEXADECIMAL_DIGITS[name]}x}"
        elif isinstance(value, bytes):
            value = value.decode(errors="replace")
        elif isinstance(value, (list, tuple)):
            value = [_element(element) for element in value]
        result[name] = value
    return result


def _element(value):
    if isinstance(value, (list, tuple, bytes)):
        return list(value)
    return as_dict(value) if hasattr(value, "__slots__") else value
