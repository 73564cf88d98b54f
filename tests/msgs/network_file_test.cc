#include "msgs/network_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/atomic_file.h"
#include "msgs/proto/network.pb.h"
#include "tests/msgs/usage_error.h"

namespace fresco {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A folder of its own for each test, removed at its end.
class NetworkFile : public testing::Test {
 protected:
  NetworkFile()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("fresco_network_file_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())),
        path_(folder_ / "best.network") {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~NetworkFile() override { std::filesystem::remove_all(folder_); }

  /// Writes the network and gives back the file's bytes.
  std::string Write(const StoredNetwork& network) const {
    WriteNetworkFile(path_, network);
    return ReadFile(path_);
  }
  void ExpectRefused(const std::string& content, const std::string& reason = "") const {
    WriteFileAtomically(path_, content);
    EXPECT_THAT(UsageErrorOf([&] { ReadNetworkFile(path_); }),
                AllOf(HasSubstr(path_.string()), HasSubstr(reason)));
  }

  const std::filesystem::path folder_;
  const std::filesystem::path path_;
};

StoredNetwork NetworkOf(const std::string& text) {
  const Experiment experiment = Experiment::Parse(text, "test");
  return {experiment, 12, 1234, InitialParameters(experiment.network_shape(), 5)};
}

constexpr char kSmall[] = "agent { hidden_layers: [3, 2] } scenario { reward { k3: 7 } } run { actors: 5 }";

TEST_F(NetworkFile, GivesBackTheNetwork) {
  const StoredNetwork written = NetworkOf(kSmall);
  Write(written);
  const StoredNetwork read = ReadNetworkFile(path_);
  EXPECT_EQ(read.experiment.Text(), written.experiment.Text());
  EXPECT_EQ(read.experiment.hash(), written.experiment.hash());
  EXPECT_EQ(read.version, 12);
  EXPECT_EQ(read.updates, 1234);
  EXPECT_EQ(read.parameters, written.parameters);
}

TEST_F(NetworkFile, IsRefusedCutShortAnywhere) {
  const std::string content = Write(NetworkOf(kSmall));
  for (size_t size = 0; size < content.size(); ++size) {
    ExpectRefused(content.substr(0, size));
  }
}

TEST_F(NetworkFile, IsRefusedCutShortBetweenFieldsOfTheDefaultExperiment) {
  // Without its configuration, it must not pass for a network of the paper's.
  proto::NetworkFile file;
  ASSERT_TRUE(file.ParseFromString(Write(NetworkOf("scenario { reward { k3: 7 } }"))));
  file.clear_software_version();
  ExpectRefused(file.SerializeAsString());
  file.clear_config_text();
  ExpectRefused(file.SerializeAsString());
}

TEST_F(NetworkFile, IsRefusedWithAFlippedByteInItsParameters) {
  const std::string content = Write(NetworkOf(kSmall));
  proto::NetworkFile file;
  ASSERT_TRUE(file.ParseFromString(content));
  const size_t begin = content.find(file.parameters());
  ASSERT_NE(begin, std::string::npos);
  for (size_t i = begin; i < begin + file.parameters().size(); i += 7) {
    std::string damaged = content;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x40);
    ExpectRefused(damaged, "CRC");
  }
}

TEST_F(NetworkFile, IsRefusedWithAnotherConfigurationThanItWasTrainedFor) {
  std::string content = Write(NetworkOf(kSmall));
  const size_t place = content.find("k3: 7");
  ASSERT_NE(place, std::string::npos);
  content[place + 4] = '8';
  ExpectRefused(content, "configuration");
}

TEST_F(NetworkFile, IsRefusedWhereItsSizesContradictItsConfiguration) {
  proto::NetworkFile file;
  ASSERT_TRUE(file.ParseFromString(Write(NetworkOf(kSmall))));
  file.set_layer_sizes(1, 4);
  ExpectRefused(file.SerializeAsString(), "layer sizes");
  file.set_layer_sizes(1, 3);
  file.mutable_parameters()->append("abcd");
  ExpectRefused(file.SerializeAsString(), "bytes of parameters");
}

TEST_F(NetworkFile, IsRefusedOfANewerFormat) {
  proto::NetworkFile file;
  ASSERT_TRUE(file.ParseFromString(Write(NetworkOf(kSmall))));
  file.set_format("fresco-network-2");
  ExpectRefused(file.SerializeAsString(), "fresco-network-2");
}

TEST_F(NetworkFile, ForeignFilesAndFoldersAreRefused) {
  ExpectRefused("PNG\r\n\x1a\n something else", "not a network file");
  ExpectRefused("", "not a network file");
  EXPECT_THAT(UsageErrorOf([&] { ReadNetworkFile(folder_); }), HasSubstr(folder_.string()));
  EXPECT_THAT(UsageErrorOf([&] { ReadNetworkFile(folder_ / "nothing"); }), HasSubstr("nothing"));
}

}  // namespace
}  // namespace fresco
