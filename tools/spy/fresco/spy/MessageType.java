package fresco.spy;

import java.io.DataInput;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.zip.CRC32C;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMEncodable;

/**
 * Decodes messages of one type, as safely as msgs/wire.h: LCM's decoders allocate as much as a count or the
 * length of a text says, so both are checked before. Immutable; any thread may use it.
 */
final class MessageType<M extends LCMEncodable> {
  /** LCM's decoder of a type: the constructor that takes a stream. */
  interface Decoder<M> {
    M decode(DataInput stream) throws IOException;
  }

  private static final int LARGEST_MESSAGE_BYTES = 1350;
  private static final int CRC_BYTES = 4;
  private static final int TAG_BYTES = 32; // behind the CRC if the run has a key file
  private static final int FIRST_COUNT = 8 + 3 * 8; // behind fingerprint, utime, run_id, config_hash

  private final Decoder<M> decoder;
  private final int texts;
  private final int firstText;
  private final int[] countMaxima;

  /**
   * @param firstText position of the first text in the encoded message
   * @param texts number of texts, one after the other
   * @param countMaxima the largest allowed value of each count, in the order of the fields
   */
  MessageType(Decoder<M> decoder, int firstText, int texts, int... countMaxima) {
    this.decoder = decoder;
    this.firstText = firstText;
    this.texts = texts;
    this.countMaxima = countMaxima;
  }

  /** Returns the message; null if it is damaged, of another type, or beyond the limits of its type. */
  M decode(LCMDataInputStream stream) {
    try {
      byte[] bytes = new byte[Math.min(stream.available(), LARGEST_MESSAGE_BYTES + 1)];
      stream.readFully(bytes);
      ByteBuffer message = ByteBuffer.wrap(bytes);
      return isSound(message) ? decoder.decode(new LCMDataInputStream(bytes)) : null;
    } catch (IOException | RuntimeException error) {
      return null;
    }
  }

  private boolean isSound(ByteBuffer message) {
    int bytes = message.capacity();
    return bytes <= LARGEST_MESSAGE_BYTES
        && (crcHolds(message, bytes - CRC_BYTES) || crcHolds(message, bytes - CRC_BYTES - TAG_BYTES))
        && countsAreAllowed(message) && textsAreAllowed(message);
  }

  private static boolean crcHolds(ByteBuffer message, int encodedBytes) {
    if (encodedBytes < FIRST_COUNT) {
      return false;
    }
    CRC32C crc = new CRC32C();
    crc.update(message.array(), 0, encodedBytes);
    return (int) crc.getValue() == message.getInt(encodedBytes);
  }

  private boolean countsAreAllowed(ByteBuffer message) {
    for (int i = 0; i < countMaxima.length; ++i) {
      int count = message.getInt(FIRST_COUNT + 4 * i);
      if (count < 0 || count > countMaxima[i]) {
        return false;
      }
    }
    return true;
  }

  private boolean textsAreAllowed(ByteBuffer message) {
    int offset = firstText;
    for (int i = 0; i < texts; ++i) {
      int length = message.getInt(offset);
      if (length < 1 || length > message.capacity() - offset) {
        return false;
      }
      offset += 4 + length;
    }
    return true;
  }
}
