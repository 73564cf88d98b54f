#include "storage/network_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.h"
#include "tests/support/error_of.h"
#include "tests/support/temporary_folder.h"

namespace fresco {
namespace {

class NetworkFile : public ::testing::Test {
 protected:
  NetworkFile()
      : path_(folder_.path() / "best.network"),
        experiment_(Experiment::Parse("agent { hidden_layers: [9] }", "a test")) {
    WriteFileAtomically(
        path_, SerializeNetworkFile({experiment_, 4, 400, experiment_.network()->InitialParameters(2)}));
  }

  void ExpectRefused(const std::string& content) {
    WriteFileAtomically(path_, content);
    EXPECT_THAT(ErrorOf([&] { ReadNetworkFile(path_); }), testing::HasSubstr(path_.string()));
  }

  const TemporaryFolder folder_;
  std::filesystem::path path_;
  Experiment experiment_;
};

TEST_F(NetworkFile, ReadsBackWhatWasWritten) {
  const StoredNetwork network = ReadNetworkFile(path_);
  EXPECT_EQ(network.version, 4);
  EXPECT_EQ(network.updates, 400);
  EXPECT_EQ(network.parameters, experiment_.network()->InitialParameters(2));
  EXPECT_EQ(network.experiment.Text(), experiment_.Text());
}

TEST_F(NetworkFile, HoldsANetworkForSets) {
  const Experiment sets = Experiment::Parse("agent { set_network {} }", "a test");
  const Vector parameters = sets.network()->InitialParameters(2);
  const StoredNetwork network = ParseNetworkFile(SerializeNetworkFile({sets, 4, 400, parameters}), "a test");
  EXPECT_EQ(network.parameters, parameters);
  EXPECT_EQ(network.experiment.network()->layer_sizes(), sets.network()->layer_sizes());
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
  EXPECT_THROW(ReadNetworkFile(folder_.path()), Error);
  EXPECT_THROW(ReadNetworkFile(folder_.path() / "absent"), Error);
}

}  // namespace
}  // namespace fresco
