#include "storage/network_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/error.h"
#include "core/files.h"

namespace fresco {
namespace {

class NetworkFile : public ::testing::Test {
 protected:
  NetworkFile()
      : directory_(std::filesystem::temp_directory_path() / ("fresco-network-" + std::to_string(getpid()))),
        path_(directory_ / "best.network"),
        experiment_(Experiment::Parse("agent { hidden_layers: [9] }", "a test")) {
    std::filesystem::create_directories(directory_);
    WriteFileAtomically(path_, SerializeNetworkFile(
                                   {experiment_, 4, 400, InitialParameters(experiment_.network_shape(), 2)}));
  }
  ~NetworkFile() override { std::filesystem::remove_all(directory_); }

  void ExpectRefused(const std::string& content) {
    WriteFileAtomically(path_, content);
    try {
      ReadNetworkFile(path_);
      FAIL() << "accepted " << content.size() << " bytes";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path_.string()), std::string::npos) << error.what();
    }
  }

  std::filesystem::path directory_;
  std::filesystem::path path_;
  Experiment experiment_;
};

TEST_F(NetworkFile, ReadsBackWhatWasWritten) {
  const StoredNetwork network = ReadNetworkFile(path_);
  EXPECT_EQ(network.version, 4);
  EXPECT_EQ(network.updates, 400);
  EXPECT_EQ(network.parameters, InitialParameters(experiment_.network_shape(), 2));
  EXPECT_EQ(network.experiment.Text(), experiment_.Text());
}

TEST_F(NetworkFile, RefusesEveryTruncation) {
  const std::string whole = ReadFile(path_);
  for (size_t size = 0; size + 20 < whole.size(); size += 37) {
    ExpectRefused(whole.substr(0, size));
  }
}

TEST_F(NetworkFile, RefusesDamagedParameters) {
  std::string content = ReadFile(path_);
  content[200] = static_cast<char>(content[200] ^ 4);
  ExpectRefused(content);
}

TEST_F(NetworkFile, RefusesForeignFiles) {
  ExpectRefused("P5 640 480");
  ExpectRefused(std::string(5000, '\n'));
  EXPECT_THROW(ReadNetworkFile(directory_), Error);
  EXPECT_THROW(ReadNetworkFile(directory_ / "absent"), Error);
}

}  // namespace
}  // namespace fresco
