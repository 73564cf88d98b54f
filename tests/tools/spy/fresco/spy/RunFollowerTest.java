package fresco.spy;

import static org.junit.Assert.assertEquals;

import fresco.spy.RunFollower.Hearing;
import org.junit.Test;

public class RunFollowerTest {
  private double nowS;
  private final RunFollower run = new RunFollower(() -> (long) (nowS * 1e9));

  @Test
  public void staysWithTheFirstRunWhileItIsHeard() {
    assertEquals(Hearing.NEW, run.hear(1));
    for (nowS = 0; nowS < 20; nowS += 2) {
      assertEquals(Hearing.SAME, run.hear(1));
      assertEquals(Hearing.OTHER, run.hear(2));
    }
    assertEquals(1, run.runId());
  }

  @Test
  public void goesOverToAnotherRunWhenTheFirstIsSilent() {
    run.hear(1);
    nowS = 2.9;
    assertEquals(Hearing.OTHER, run.hear(2));
    nowS = 3.1;
    assertEquals(3.1, run.silentS(), 1e-6);
    assertEquals(Hearing.NEW, run.hear(2));
    assertEquals(Hearing.SAME, run.hear(2));
    assertEquals(Hearing.OTHER, run.hear(1));
    assertEquals(2, run.runId());
    assertEquals(0, run.silentS(), 0);
  }
}
