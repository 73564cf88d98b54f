package fresco.spy;

/** Shows the numbers of an episode. Used on the event thread. */
final class EpisodeFacts {
  private final Facts facts = new Facts(
      1, "world", "run", "episode", "order", "flown by", "seed", "steps", "return", "ended", "not drawn");

  Facts component() { return facts; }

  /** @param kind what kind of episode it is, for people */
  void show(Episode episode, String kind) {
    WorldNames names = episode.names();
    int leftOut = new FieldGroups(names.state()).leftOut;
    facts.set("world", names.world());
    facts.set("run", String.format("%016x", episode.runId()));
    facts.set("episode", kind);
    facts.set("order", Long.toString(episode.order()));
    facts.set("flown by", episode.actor());
    facts.set("seed", String.format("%016x", episode.seed()));
    facts.set("steps", String.format("%,d, at most %,d", episode.steps(), names.longestEpisode()));
    facts.set("return", Text.amount(episode.sumOfRewards()));
    facts.set("ended", episode.endingName());
    facts.set("not drawn",
        leftOut == 0 ? "nothing" : String.format("%,d of %,d fields", leftOut, names.state().size()));
  }
}
