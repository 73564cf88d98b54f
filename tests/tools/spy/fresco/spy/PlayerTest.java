package fresco.spy;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNull;
import static org.junit.Assert.assertSame;

import org.junit.Test;

public class PlayerTest {
  private final Episodes episodes = new Episodes();
  private final LiveFlights liveFlights = new LiveFlights();
  private final Player player = new Player();

  /** Of ten slots. */
  private Flight episode(long order) {
    return Flight.of(episodes.add(Messages.transitions(1, order, 0, 9, 1), Messages.uav()));
  }

  private void pass(double seconds) {
    for (int i = 0; i < Math.round(seconds / 0.04); ++i) {
      player.tick(0.04);
    }
  }

  @Test
  public void playsAnEpisodeToItsEndAndThenTheNewestOne() {
    player.tick(0.04);
    assertNull(player.flight());
    Flight first = episode(1);
    player.offer(first, false);
    pass(0.5);
    player.offer(episode(2), false);
    Flight third = episode(3);
    player.offer(third, false);
    assertSame(first, player.flight());
    assertEquals(4, player.position(), 0.5); // eight slots a second
    pass(1);
    assertSame(first, player.flight());
    assertEquals(10, player.shownSteps());
    pass(2);
    assertSame(third, player.flight());
    pass(60);
    assertSame(third, player.flight());
    assertEquals(10, player.shownSteps());
  }

  @Test
  public void playsEvaluationsOnlyWhereTheyAreChosen() {
    player.choose(Player.Choice.EVALUATIONS);
    Flight evaluation = episode(1);
    player.offer(evaluation, true);
    player.offer(episode(2), false);
    pass(10);
    assertSame(evaluation, player.flight());
  }

  @Test
  public void showsALiveFlightAtOnceAndEpisodesWhenItIsSilent() {
    player.offer(episode(1), false);
    pass(0.2);
    Flight live = liveFlights.add(Messages.flight(4, 0, 1, 3));
    player.follow(live);
    assertSame(live, player.flight());
    for (int slot = 2; slot <= 40; ++slot) { // faster than it is played
      assertSame(live, liveFlights.add(Messages.flight(4, 0, slot, 3)));
      player.follow(live);
      player.tick(0.04);
    }
    pass(2);
    assertEquals(40, player.shownSteps());
    Flight next = episode(2);
    player.offer(next, false);
    pass(5);
    assertSame(next, player.flight());
  }

  @Test
  public void beginsAnewWithEveryLiveFlight() {
    Flight first = liveFlights.add(Messages.flight(4, 0, 1, 3));
    player.follow(first);
    Flight second = liveFlights.add(Messages.flight(4, 1, 1, 3));
    player.follow(second);
    assertSame(second, player.flight());
    assertEquals(0, player.position(), 0);
    assertSame(second, liveFlights.add(Messages.flight(4, 1, 2, 3)));
    Flight ofAnotherRun = liveFlights.add(Messages.flight(5, 1, 3, 3));
    assertEquals(1, ofAnotherRun.steps.size());
  }

  @Test
  public void standsStillWhereItIsPaused() {
    player.offer(episode(1), false);
    pass(0.5);
    double position = player.position();
    player.setPaused(true);
    pass(10);
    assertEquals(position, player.position(), 0);
  }
}
