"""Transitions as rows, with the names that their world gives."""
ENDINGS = ("none", "terminal", "truncated")
MAXIMUM_COUNTS = {"state_size": 10_000, "action_count": 4_000, "figure_count": 100}


class WorldNames:
    """What the world_t messages of a run say of its world: `state` and `figures` are lists of (name, unit), `actions`
    is a list of names. They are known if it is_complete."""

    def __init__(self):
        self._world, self._entries = None, []
        self.state, self.actions, self.figures = [], [], []

    @property
    def is_complete(self):
        return bool(self.state)

    def add(self, world):
        """Takes a message; ignores one with absurd numbers."""
        counts = [getattr(world, name) for name in MAXIMUM_COUNTS]
        if world.first_entry < 0 or not all(1 <= count <= maximum
                                            for count, maximum in zip(counts, MAXIMUM_COUNTS.values())):
            return
        if self._world != (world.config_hash, world.world, *counts):
            self.__init__()
            self._world, self._entries = (world.config_hash, world.world, *counts), [None] * sum(counts)
        for number, line in enumerate(world.entries.split("\n")[:-1], world.first_entry):
            if number < len(self._entries):
                self._entries[number] = line
        if not self.is_complete and None not in self._entries:
            states, actions, _ = counts
            self.state = [_name_and_unit(line) for line in self._entries[:states]]
            self.actions = self._entries[states:states + actions]
            self.figures = [_name_and_unit(line) for line in self._entries[states + actions:]]


def _name_and_unit(line):
    name, bracket, unit = line.rpartition(" [")
    return (name, unit[:-1]) if bracket and unit.endswith("]") else (line, "")


def rows_of(message, names=None):
    """A dictionary for each transition of a transitions_t, with the columns of `fresco log export`; none if the
    message's numbers contradict each other."""
    if message.state_count != message.transition_count + 1 or not 0 <= message.ending < len(ENDINGS) \
            or message.first_field < 0:
        return
    fields = [names.state[number][0] if names and number < len(names.state) else f"state_{number}"
              for number in range(message.first_field, message.first_field + message.field_count)]
    actions = names.actions if names else []
    for i, action in enumerate(message.action):
        is_last = i + 1 == message.transition_count
        mask = message.next_mask[i]
        allowed = (a for a in range(len(actions) or 8 * len(mask)) if a // 8 < len(mask) and mask[a // 8] >> a % 8 & 1)
        yield {"utime": message.utime, "run_id": f"{message.run_id & (1 << 64) - 1:016x}",
               "order_index": message.order_index, "actor_id": message.actor_id, "seed": message.seed,
               "transition": message.first_transition + i, "ending": ENDINGS[message.ending if is_last else 0],
               **dict(zip(fields, message.state[i])), "action": action,
               "action_name": actions[action] if 0 <= action < len(actions) else "",
               "reward": message.reward[i], "td_error": message.td_error[i],
               **{"next_" + name: value for name, value in zip(fields, message.state[i + 1])},
               "next_allowed_actions": " ".join(map(str, allowed))}
