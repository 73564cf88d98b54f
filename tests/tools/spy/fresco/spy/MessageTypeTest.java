package fresco.spy;

import static org.junit.Assert.assertArrayEquals;
import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertNull;

import fresco.flight_t;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.Arrays;
import lcm.lcm.LCMDataInputStream;
import org.junit.Test;

public class MessageTypeTest {
  private static final int FIRST_COUNT = 32;

  private static flight_t decoded(byte[] bytes) {
    return MessageTypes.FLIGHT.decode(new LCMDataInputStream(bytes));
  }

  private static byte[] encoding() throws IOException {
    byte[] message = Messages.encoded(Messages.flight(5, 0, 3, 4), 0);
    return Arrays.copyOf(message, message.length - 4);
  }

  @Test
  public void decodesAMessageWithATagBehindItAndWithout() throws IOException {
    for (int tagBytes : new int[] {0, 32}) {
      flight_t message = decoded(Messages.encoded(Messages.flight(5, 0, 3, 4), tagBytes));
      assertEquals(3, message.slot);
      assertEquals("aoi", message.policy);
      assertArrayEquals(new short[] {3, 3, 3, 3}, message.aoi);
    }
  }

  @Test
  public void leavesOutWhatIsDamagedOrCutShort() throws IOException {
    byte[] whole = Messages.encoded(Messages.flight(5, 0, 3, 4), 0);
    for (int size = 0; size < whole.length; ++size) {
      assertNull("cut at " + size, decoded(Arrays.copyOf(whole, size)));
    }
    for (int place = 0; place < whole.length; ++place) {
      byte[] changed = whole.clone();
      changed[place] ^= 1;
      assertNull("changed at " + place, decoded(changed));
    }
  }

  @Test
  public void leavesOutAnAbsurdCountWithoutAllocatingIt() throws IOException {
    for (int count : new int[] {251, 500_000_000, Integer.MAX_VALUE, -1, Integer.MIN_VALUE}) {
      byte[] encoding = encoding();
      ByteBuffer.wrap(encoding).putInt(FIRST_COUNT, count);
      assertNull(decoded(Messages.withTrailer(encoding, 0)));
    }
  }

  @Test
  public void leavesOutATextOfAbsurdLength() throws IOException {
    byte[] encoding = encoding();
    int text = encoding.length - 4 * 2 - 4 - 4; // before four ages and "aoi" with its NUL
    assertEquals(4, ByteBuffer.wrap(encoding).getInt(text));
    for (int length : new int[] {0, -1, 400_000_000, Integer.MAX_VALUE, Integer.MIN_VALUE}) {
      ByteBuffer.wrap(encoding).putInt(text, length);
      assertNull(decoded(Messages.withTrailer(encoding, 0)));
    }
  }

  @Test
  public void leavesOutAnotherType() throws IOException {
    assertNull(decoded(Messages.encoded(Messages.scenario(5, 0, 3, 3), 0)));
  }
}
