#include "tests/bench/pytorch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace fresco {
namespace {

constexpr char kPython[] = "/usr/bin/python3";  // the one that has Debian's python3-torch

/// What may be the fastest on this processor: OpenBLAS's and PyTorch's choice of kernels, or another one.
/// Each is a line of settings for the environment.
std::vector<std::string> Kernels() {
  std::istringstream lines(ReadFile(FRESCO_BENCH_FOLDER "/pytorch_kernels"));
  std::vector<std::string> kernels;
  for (std::string line; std::getline(lines, line);) {
    kernels.push_back(line);
  }
  return kernels;
}

}  // namespace

PyTorchUpdates::PyTorchUpdates(const std::string& kernels, double seconds) {
  int requests[2];
  int answers[2];
  FRESCO_CHECK(pipe2(requests, O_CLOEXEC) == 0 && pipe2(answers, O_CLOEXEC) == 0);
  requests_ = requests[1];
  answers_ = answers[0];
  std::vector<std::string> command = {"/usr/bin/env", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
  for (size_t begin = 0; begin < kernels.size();) {
    const size_t end = std::min(kernels.find(' ', begin), kernels.size());
    command.push_back(kernels.substr(begin, end - begin));
    begin = end + 1;
  }
  command.insert(command.end(),
                 {kPython, FRESCO_BENCH_FOLDER "/pytorch_update.py", fmt::format("{}", seconds)});
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  process_ = std::make_unique<ChildProcess>(command, ChildProcess::Streams{requests[0], answers[1], nowhere});
  for (const int descriptor : {requests[0], answers[1], nowhere}) {
    close(descriptor);
  }
  if (const std::string way = ReadLine(); !way.empty()) {
    description_ = fmt::format("PyTorch {}, {}", way, kernels);
  }
}

PyTorchUpdates::~PyTorchUpdates() {
  close(requests_);
  close(answers_);
}

std::vector<std::unique_ptr<PyTorchUpdates>> PyTorchUpdates::StartAll(double seconds, std::string& reason) {
  const std::string find = fmt::format(
      "{} -c 'import importlib.util, sys; sys.exit(importlib.util.find_spec(\"torch\") is None)' 2>/dev/null",
      kPython);
  if (std::system(find.c_str()) != 0) {
    reason = "PyTorch is not installed: apt-get install --no-install-recommends python3-torch";
    return {};
  }
  std::vector<std::unique_ptr<PyTorchUpdates>> all;
  for (const std::string& kernels : Kernels()) {
    std::unique_ptr<PyTorchUpdates> one(new PyTorchUpdates(kernels, seconds));
    if (!one->description_.empty()) {
      all.push_back(std::move(one));
    }
  }
  if (all.empty()) {
    reason = fmt::format("PyTorch made no update; see what {} says: {}/pytorch_update.py 0.1", kPython,
                         FRESCO_BENCH_FOLDER);
  }
  return all;
}

void PyTorchUpdates::Make(int updates) {
  const std::string request = fmt::format("{}\n", updates);
  if (write(requests_, request.data(), request.size()) != static_cast<ssize_t>(request.size()) ||
      ReadLine() != "done") {
    throw Failure("PyTorch's process ended during the updates");
  }
}

std::string PyTorchUpdates::ReadLine() {
  std::string line;
  for (char c = 0; read(answers_, &c, 1) == 1 && c != '\n';) {
    line += c;
  }
  return line;
}

}  // namespace fresco
