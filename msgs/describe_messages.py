#!/usr/bin/env python3
"""Describes the messages of .lcm files for C++, Java and Python: names, limits and offsets of their fields.

    describe_messages.py --cpp HEADER FILE.lcm...
    describe_messages.py --java CLASS_FILE FILE.lcm...
    describe_messages.py --python MODULE FILE.lcm...

A message that has a channel of its own begins with utime, run_id and config_hash. Its counts come next, then the
fields of fixed size, then the texts, then the arrays: so that a decoder can check every count and every text
before LCM's own decoder trusts them. A count C has a constant MAXIMUM_C, a text T a constant MAXIMUM_T_BYTES in the
same .lcm file. This program fails with file and reason if a message breaks these rules.
"""
import argparse
import pathlib
import re
import sys

FIXED_BYTES = {"int8_t": 1, "int16_t": 2, "int32_t": 4, "int64_t": 8, "float": 4, "double": 8, "byte": 1, "boolean": 1}
IDENTITY = ["utime", "run_id", "config_hash"]
FINGERPRINT_BYTES = 8


class Field:
    def __init__(self, kind, name, dimensions):
        self.kind, self.name, self.dimensions = kind, name, dimensions
        self.is_text = kind == "string" and not dimensions
        self.is_fixed = kind in FIXED_BYTES and not dimensions


class Message:
    """One struct of a .lcm file, checked against the rules above."""

    def __init__(self, path):
        self.path = path
        text = re.sub(r"//[^\n]*", "", path.read_text())
        struct = re.fullmatch(r"\s*package (\w+);\s*struct (\w+)\s*\{(.*)\}\s*", text, re.DOTALL)
        if not struct:
            raise ValueError(f"{path}: expected one package and one struct")
        self.package, self.name, body = struct.groups()
        self.constants, self.fields = {}, []
        for statement in filter(None, map(str.strip, body.split(";"))):
            self.take(statement)
        self.counts = [field for field in self.fields if any(field.name in other.dimensions for other in self.fields)]
        self.texts = [field for field in self.fields if field.is_text]
        self.has_channel = True  # until another message has it as a field

    def use(self, others):
        """Checks the message, unless one of the others has it as a field."""
        self.has_channel = not any(field.kind == self.name for other in others for field in other.fields)
        if self.has_channel:
            self.check()

    def take(self, statement):
        constant = re.fullmatch(r"const int32_t (\w+) = (\d+)", statement)
        field = re.fullmatch(r"(\w+)\s+(\w+)((?:\[\w+\])*)", statement)
        if constant:
            self.constants[constant[1]] = int(constant[2])
        elif field:
            self.fields.append(Field(field[1], field[2], re.findall(r"\w+", field[3])))
        else:
            raise ValueError(f"{self.path}: expected a field or a constant, found: {statement}")

    def check(self):
        if [field.name for field in self.fields[:3]] != IDENTITY:
            raise ValueError(f"{self.path}: expected the fields {', '.join(IDENTITY)} first; a struct without them has "
                             f"to be a field of another message")
        counts, texts = len(self.counts), len(self.texts)
        fixed = sum(field.is_fixed for field in self.fields)
        in_order = (self.fields[3:3 + counts] == self.counts and all(field.kind == "int32_t" for field in self.counts)
                    and all(field.is_fixed for field in self.fields[:fixed])
                    and self.fields[fixed:fixed + texts] == self.texts)
        if not in_order:
            raise ValueError(f"{self.path}: expected utime, run_id, config_hash, then the counts (int32_t), then the "
                             f"fields of fixed size, then texts, then arrays")
        for name in [f"MAXIMUM_{field.name.upper()}" for field in self.counts] + \
                    [f"MAXIMUM_{field.name.upper()}_BYTES" for field in self.texts]:
            if name not in self.constants:
                raise ValueError(f"{self.path}: expected a constant {name}")

    def maxima(self):
        return [self.constants[f"MAXIMUM_{field.name.upper()}"] for field in self.counts]

    def offsets(self):
        """(name, byte) of every field of fixed size."""
        offset = FINGERPRINT_BYTES
        for field in self.fields:
            if not field.is_fixed:
                return
            yield field.name, offset
            offset += FIXED_BYTES[field.kind]

    def fixed_bytes(self):
        return FINGERPRINT_BYTES + sum(FIXED_BYTES[field.kind] for field in self.fields if field.is_fixed)

    def array_bytes(self):
        """The C++ sum of the bytes of all arrays of numbers, by the counts; None if there are other arrays."""
        terms = []
        for field in self.fields:
            if field.dimensions and field.kind not in FIXED_BYTES:
                return None
            if field.dimensions:
                terms.append(" * ".join([str(FIXED_BYTES[field.kind]), *field.dimensions]))
        return " + ".join(terms)


def description(message):
    lines = [f"template <>", f"struct Description<{message.name}> {{"]
    if message.has_channel:
        maxima = ", ".join(map(str, message.maxima()))
        lines += [f"  static constexpr std::array<int32_t, {len(message.counts)}> kCountMaxima = {{{maxima}}};",
                  f"  static constexpr int kTexts = {len(message.texts)};",
                  f"  static constexpr size_t kFixedBytes = {message.fixed_bytes()};"]
        lines += [f"  static constexpr size_t {name}_offset = {offset};" for name, offset in message.offsets()]
        if not message.texts and message.array_bytes():
            counts = ", ".join(f"size_t {field.name}" for field in message.counts)
            lines.append(f"  static constexpr size_t EncodedBytes({counts}) {{ return kFixedBytes + "
                         f"{message.array_bytes()}; }}")
    lines += ["  template <class Visitor>", f"  static void ForEachField(const {message.name}& message, Visitor&& visit) {{"]
    lines += [f'    visit("{field.name}", message.{field.name});' for field in message.fields]
    return lines + ["  }", "};", ""]


def cpp(messages):
    with_channel = [message.name for message in messages if message.has_channel]
    return "\n".join([
        "// Made by msgs/describe_messages.py from the .lcm files.", "#pragma once", "",
        "#include <array>", "#include <cstddef>", "#include <cstdint>", "#include <tuple>", "",
        *[f'#include "{message.package}/{message.name}.hpp"' for message in messages], "",
        f"namespace {messages[0].package} {{", "",
        "/// Every message that has a channel of its own.",
        f"using MessageTypes = std::tuple<{', '.join(with_channel)}>;", "",
        "/// What LCM's own code does not tell of a message: the largest allowed value of each count, in the order of",
        "/// the fields; how many texts it has; the encoded bytes before its first text or array, and where among them",
        "/// each field begins, LCM's fingerprint included; its fields by name, for those who show or export them.",
        "template <class Message>", "struct Description;", "",
        *[line for message in messages for line in description(message)],
        f"}}  // namespace {messages[0].package}", ""])


def java(messages):
    with_channel = [message for message in messages if message.has_channel]
    lines = ["// Made by msgs/describe_messages.py from the .lcm files.", "package fresco.spy;", "",
             *[f"import {message.package}.{message.name};" for message in with_channel], "",
             "/** Every message that has a channel of its own. */", "final class MessageTypes {"]
    for message in with_channel:
        constant = message.name.removesuffix("_t").upper()
        numbers = ", ".join(map(str, [message.fixed_bytes(), len(message.texts), *message.maxima()]))
        lines.append(f"  static final MessageType<{message.name}> {constant} = "
                     f"new MessageType<>({message.name}::new, {numbers});")
    return "\n".join([*lines, "", "  private MessageTypes() {}", "}", ""])


def python(messages):
    with_channel = [message for message in messages if message.has_channel]
    names = ", ".join(message.name for message in with_channel)
    lines = ['"""Made by msgs/describe_messages.py from the .lcm files."""', f"from .{messages[0].package} import {names}",
             "", "# Of every message that has a channel of its own: the type, the encoded bytes before its first text or array,",
             "# the number of its texts, and the largest allowed value of each count.", "MESSAGE_TYPES = ["]
    lines += [f"    ({message.name}, {message.fixed_bytes()}, {len(message.texts)}, {message.maxima()}),"
              for message in with_channel]
    return "\n".join([*lines, "]", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    language = parser.add_mutually_exclusive_group(required=True)
    language.add_argument("--cpp", type=pathlib.Path, metavar="HEADER")
    language.add_argument("--java", type=pathlib.Path, metavar="CLASS_FILE")
    language.add_argument("--python", type=pathlib.Path, metavar="MODULE")
    parser.add_argument("files", type=pathlib.Path, nargs="+", metavar="FILE.lcm")
    options = parser.parse_args()
    try:
        messages = [Message(path) for path in options.files]
        for message in messages:
            message.use(messages)
    except ValueError as error:
        sys.exit(f"describe_messages.py: {error}")
    output = options.cpp or options.java or options.python
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text((cpp if options.cpp else java if options.java else python)(messages))


if __name__ == "__main__":
    main()
