package fresco.spy;

import static org.junit.Assert.assertNull;
import static org.junit.Assert.assertSame;

import org.junit.Test;

public class EpisodeChoiceTest {
  private final Episodes episodes = new Episodes();
  private final EpisodeChoice choice = new EpisodeChoice();

  private Episode episode(long order) {
    return episodes.add(Messages.transitions(1, order, 0, 9, 1), Messages.uav());
  }

  @Test
  public void showsTheNewestOneForAWhile() {
    assertNull(choice.tick(0.1));
    Episode first = episode(1);
    choice.offer(first, false);
    assertSame(first, choice.tick(0.1));
    choice.offer(episode(2), false);
    assertNull(choice.tick(1));
    Episode third = episode(3);
    choice.offer(third, false);
    assertSame(third, choice.tick(1.1));
    assertNull(choice.tick(60));
  }

  @Test
  public void showsEvaluationsOnlyWhereTheyAreChosen() {
    Episode evaluation = episode(1);
    choice.offer(evaluation, true);
    choice.offer(episode(2), false);
    choice.choose(EpisodeChoice.Kind.EVALUATIONS);
    assertSame(evaluation, choice.tick(0.1));
  }

  @Test
  public void standsStillWhereItIsPaused() {
    Episode first = episode(1);
    choice.offer(first, false);
    assertSame(first, choice.tick(0.1));
    choice.setPaused(true);
    Episode second = episode(2);
    choice.offer(second, false);
    assertNull(choice.tick(60));
    choice.setPaused(false);
    assertSame(second, choice.tick(0.1));
  }
}
