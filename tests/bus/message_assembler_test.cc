// Datagrams made by hand, honest and hostile, and the messages that come out.
#include "bus/message_assembler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bus/message_assembler.h"
#include "tests/bus/lcm_datagrams.h"
#include "tests/bus/text_messages.h"

namespace fresco {
namespace {

constexpr uint64_t kSender = 1;

/// What comes out of datagrams of one sender: "channel: content".
class MessageAssemblerTest : public ::testing::Test {
 protected:
  std::vector<std::string> Heard(const std::vector<std::string>& datagrams, uint64_t sender = kSender) {
    std::vector<std::string> heard;
    for (const std::string& datagram : datagrams) {
      const std::vector<char> exact(datagram.begin(),
                                    datagram.end());  // a sanitizer sees reads beyond its end
      if (const auto message = assembler_.Add(std::as_bytes(std::span(exact)), sender, utime_)) {
        heard.push_back(message->channel + ": " + Text(message->content));
      }
    }
    return heard;
  }

  void ExpectRefused(const std::string& datagram) {
    const int64_t before = assembler_.refused_datagrams();
    EXPECT_EQ(Heard({datagram}), std::vector<std::string>{});
    EXPECT_EQ(assembler_.refused_datagrams(), before + 1);
    EXPECT_EQ(assembler_.memory_bytes(), 0u);
  }

  MessageAssembler assembler_;
  int64_t utime_ = 1'700'000'000'000'000;
};

using Strings = std::vector<std::string>;

/// A message of 12 bytes in three fragments.
const Strings kThree = {
    FragmentDatagram({.message_bytes = 12, .offset = 0, .number = 0, .count = 3}, OnA("one ")),
    FragmentDatagram({.message_bytes = 12, .offset = 4, .number = 1, .count = 3}, "two "),
    FragmentDatagram({.message_bytes = 12, .offset = 8, .number = 2, .count = 3}, "3of3")};
const Strings kThreeHeard = {"A: one two 3of3"};

TEST_F(MessageAssemblerTest, TakesAWholeMessage) {
  EXPECT_EQ(Heard({WholeDatagram(OnA("content")), WholeDatagram(OnA("")),
                   WholeDatagram(std::string(63, 'C') + std::string("\0x\0y", 4))}),
            (Strings{"A: content", "A: ", std::string(63, 'C') + ": " + std::string("x\0y", 3)}));
}

TEST_F(MessageAssemblerTest, RefusesWhatIsNotLcms) {
  for (const std::string& datagram :
       {std::string(), std::string("LC"), std::string("LC02"), std::string("LC02\0\0\0\0", 8),
        std::string(64, '\0'), "LC04" + WholeDatagram(OnA("x")).substr(4), WholeDatagram("A"),
        WholeDatagram(std::string("\0x", 2)), WholeDatagram(std::string(64, 'C') + '\0')}) {
    ExpectRefused(datagram);
  }
}

TEST_F(MessageAssemblerTest, PutsFragmentsTogetherInEveryOrder) {
  Strings order = kThree;
  std::sort(order.begin(), order.end());
  do {
    EXPECT_EQ(Heard(order), kThreeHeard);
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(assembler_.memory_bytes(), 0u);
  EXPECT_EQ(assembler_.incomplete_messages(), 0);
  EXPECT_EQ(assembler_.refused_datagrams(), 0);
}

TEST_F(MessageAssemblerTest, TakesAMessageOfOneFragmentAndOneWithoutContent) {
  EXPECT_EQ(Heard({FragmentDatagram({.message_bytes = 3, .count = 1}, OnA("one")),
                   FragmentDatagram({.message_bytes = 0, .count = 1}, OnA(""))}),
            (Strings{"A: one", "A: "}));
}

TEST_F(MessageAssemblerTest, RefusesFragmentsOutsideOfTheirMessage) {
  for (const uint32_t offset : {0xFFFFFFF0u, 0xFFFFFFFFu, 0x80000000u, 0x7FFFFFFFu, 1000u, 65u, 64u, 45u}) {
    for (const uint32_t count : {1u, 2u}) {
      for (uint32_t number = 0; number < count; ++number) {
        const std::string data(20, 'x');
        ExpectRefused(FragmentDatagram({7, 64, offset, number, count}, number == 0 ? OnA(data) : data));
      }
    }
  }
}

TEST_F(MessageAssemblerTest, RefusesImpossibleNumbers) {
  ExpectRefused(FragmentDatagram({.message_bytes = 1, .number = 0, .count = 0}, OnA("x")));
  ExpectRefused(FragmentDatagram({.message_bytes = 1, .number = 1, .count = 1}, "x"));
  ExpectRefused(FragmentDatagram({.message_bytes = 1, .number = 65535, .count = 2}, "x"));
  ExpectRefused(FragmentDatagram({.message_bytes = kMaximumLcmMessageBytes + 1, .count = 2}, OnA("x")));
  ExpectRefused(FragmentDatagram({.message_bytes = 0xFFFFFFFF, .count = 2}, OnA("x")));
}

TEST_F(MessageAssemblerTest, RefusesFragmentsThatAreCutShort) {
  const std::string whole = FragmentDatagram({.message_bytes = 0, .count = 1}, OnA(""));
  for (size_t size = 0; size < whole.size(); ++size) {
    ExpectRefused(whole.substr(0, size));
  }
  ExpectRefused(FragmentDatagram({.message_bytes = 9, .count = 1}, std::string("\0x", 2)));
  ExpectRefused(FragmentDatagram({.message_bytes = 99, .count = 1}, std::string(64, 'C') + '\0'));
}

TEST_F(MessageAssemblerTest, IgnoresAFragmentThatComesAgain) {
  EXPECT_EQ(Heard({kThree[0], kThree[0], kThree[1], kThree[0], kThree[1], kThree[2]}), kThreeHeard);
  EXPECT_EQ(assembler_.refused_datagrams(), 0);
}

TEST_F(MessageAssemblerTest, DoesNotTakeADuplicateForAMissingFragment) {
  EXPECT_EQ(Heard({kThree[0], kThree[0], kThree[0], kThree[1], kThree[1]}), Strings{});
  EXPECT_EQ(assembler_.incomplete_messages(), 1);
  EXPECT_EQ(Heard({kThree[2]}), kThreeHeard);
  EXPECT_EQ(assembler_.incomplete_messages(), 0);
}

TEST_F(MessageAssemblerTest, BelievesTheFirstOfFragmentsThatContradictEachOther) {
  const FragmentFields first{.message_bytes = 12, .offset = 0, .number = 0, .count = 3};
  const FragmentFields second{.message_bytes = 12, .offset = 4, .number = 1, .count = 3};
  const Strings contradictions = {
      FragmentDatagram(first, OnA("ONE ")),
      FragmentDatagram(first, OnA("one")),
      FragmentDatagram(first, std::string("B\0one ", 6)),
      FragmentDatagram({7, 12, 1, 0, 3}, OnA("one ")),
      FragmentDatagram({7, 13, 4, 1, 3}, "two "),  // another size
      FragmentDatagram({7, 11, 4, 1, 3}, "two "),
      FragmentDatagram({7, 12, 4, 1, 2}, "two "),  // another count
      FragmentDatagram({7, 12, 4, 1, 4}, "two "),
      FragmentDatagram({7, 12, 3, 1, 3}, "two "),  // overlaps fragment 0
      FragmentDatagram({7, 12, 0, 2, 3}, "3of3"),  // before fragment 0
  };
  EXPECT_EQ(Heard({kThree[0]}), Strings{});
  EXPECT_EQ(Heard(contradictions), Strings{});
  EXPECT_EQ(assembler_.refused_datagrams(), static_cast<int64_t>(contradictions.size()));
  EXPECT_EQ(Heard({kThree[2], FragmentDatagram(second, "two  "), kThree[1]}), kThreeHeard);  // one overlaps 2
  EXPECT_EQ(assembler_.refused_datagrams(), static_cast<int64_t>(contradictions.size()) + 1);
}

TEST_F(MessageAssemblerTest, DropsAMessageWithAHole) {
  for (const Strings& holes : {Strings{FragmentDatagram({7, 12, 0, 0, 2}, OnA("one ")),  //
                                       FragmentDatagram({7, 12, 8, 1, 2}, "3of3")},
                               Strings{FragmentDatagram({7, 12, 4, 0, 1}, OnA("two 3of3"))},
                               Strings{FragmentDatagram({7, 12, 0, 0, 1}, OnA("one two "))}}) {
    const int64_t before = assembler_.incomplete_messages();
    EXPECT_EQ(Heard(holes), Strings{});
    EXPECT_EQ(assembler_.incomplete_messages(), before + 1);
    EXPECT_EQ(assembler_.memory_bytes(), 0u);
  }
  EXPECT_EQ(Heard(kThree), kThreeHeard);  // the same sender and sequence
}

TEST_F(MessageAssemblerTest, KeepsSendersAndSequencesApart) {
  const auto fragment = [](uint32_t sequence, uint32_t number, const std::string& data) {
    return FragmentDatagram({sequence, 2, number, number, 2}, number == 0 ? OnA(data) : data);
  };
  EXPECT_EQ(Heard({fragment(1, 0, "a"), fragment(2, 1, "d")}, 1), Strings{});
  EXPECT_EQ(Heard({fragment(1, 0, "e")}, 2), Strings{});
  EXPECT_EQ(Heard({fragment(2, 1, "h")}, 3), Strings{});
  EXPECT_EQ(Heard({fragment(1, 1, "f")}, 2), Strings{"A: ef"});
  EXPECT_EQ(Heard({fragment(2, 0, "c"), fragment(1, 1, "b")}, 1), (Strings{"A: cd", "A: ab"}));
  EXPECT_EQ(Heard({fragment(2, 0, "g")}, 3), Strings{"A: gh"});
}

TEST_F(MessageAssemblerTest, TakesWholeMessagesBetweenTheFragmentsOfAnother) {
  EXPECT_EQ(Heard({kThree[0], WholeDatagram(OnA("x")), kThree[1], WholeDatagram(OnA("y")), kThree[2]}),
            (Strings{"A: x", "A: y", kThreeHeard[0]}));
}

TEST_F(MessageAssemblerTest, TakesNoMemoryForWhatWasOnlyClaimed) {
  EXPECT_EQ(Heard({FragmentDatagram({7, kMaximumLcmMessageBytes, 0, 0, 65535}, OnA("x"))}), Strings{});
  EXPECT_LT(assembler_.memory_bytes(), 1000u);
}

TEST_F(MessageAssemblerTest, GivesUpTheMessageThatWaitedLongestIfThereIsNoMemory) {
  assembler_ = MessageAssembler(100'000);
  const std::string kilobyte(1000, 'x');
  const auto begin = [&](uint32_t sequence) {
    return FragmentDatagram({sequence, 2000, 0, 0, 2}, OnA(kilobyte));
  };
  const auto end = [&](uint32_t sequence) {
    return FragmentDatagram({sequence, 2000, 1000, 1, 2}, kilobyte);
  };
  constexpr uint32_t kMessages = 1000;
  for (uint32_t sequence = 0; sequence < kMessages; ++sequence) {
    EXPECT_EQ(Heard({begin(sequence), begin(0)}), Strings{});  // the first is touched again and again
    EXPECT_LE(assembler_.memory_bytes(), 100'000u);
  }
  EXPECT_EQ(assembler_.incomplete_messages(), kMessages);
  const Strings whole = {"A: " + kilobyte + kilobyte};
  EXPECT_EQ(Heard({end(0)}), whole);
  EXPECT_EQ(Heard({end(kMessages - 1)}), whole);
  EXPECT_EQ(Heard({end(1)}), Strings{});
}

TEST_F(MessageAssemblerTest, LetsOneMessageAloneTakeMoreThanTheLimit) {
  assembler_ = MessageAssembler(10'000);
  std::string content;
  Strings datagrams;
  for (uint32_t i = 0; i < 100; ++i) {
    const std::string data(1000, static_cast<char>('a' + i % 26));
    datagrams.push_back(FragmentDatagram({7, 100'000, 1000 * i, i, 100}, i == 0 ? OnA(data) : data));
    content += data;
  }
  EXPECT_EQ(Heard({FragmentDatagram({8, 10'000, 0, 0, 2}, OnA(std::string(5000, 'x')))}), Strings{});
  EXPECT_EQ(Heard(datagrams), Strings{"A: " + content});
  EXPECT_EQ(assembler_.incomplete_messages(), 1);
  EXPECT_EQ(assembler_.memory_bytes(), 0u);
}

TEST_F(MessageAssemblerTest, GivesUpAMessageThatGetsNoFurtherFragment) {
  EXPECT_EQ(Heard({kThree[0]}), Strings{});
  utime_ += MessageAssembler::kPatienceUs;
  EXPECT_EQ(Heard({kThree[1]}), Strings{});
  utime_ += MessageAssembler::kPatienceUs;
  EXPECT_EQ(Heard({kThree[2]}), kThreeHeard);
  EXPECT_EQ(Heard({kThree[0], kThree[1]}), Strings{});
  utime_ += MessageAssembler::kPatienceUs + 1;
  const FragmentFields other{.message_bytes = 5,
                             .count = 1};  // the same sender and sequence, another message
  EXPECT_EQ(Heard({FragmentDatagram(other, OnA("other"))}), Strings{"A: other"});
  EXPECT_EQ(assembler_.incomplete_messages(), 1);
}

}  // namespace
}  // namespace fresco
