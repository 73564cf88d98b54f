// Settings of the command line, one a line; the last line is a run's id. A setting changes the field that
// it names and no other.
#include <google/protobuf/util/message_differencer.h>

#include "core/error.h"
#include "core/identifier.h"
#include "msgs/config_reflection.h"
#include "msgs/experiment.h"
#include "tests/fuzz/fuzz_input.h"

namespace fresco {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Scalars that are set, counting entries of repeated ones as one.
int SetScalars(const Message& message) {
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  int count = 0;
  for (const FieldDescriptor* field : fields) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      ++count;
    } else if (field->is_repeated()) {
      for (int i = 0; i < message.GetReflection()->FieldSize(message, field); ++i) {
        count += SetScalars(message.GetReflection()->GetRepeatedMessage(message, field, i));
      }
    } else {
      count += SetScalars(message.GetReflection()->GetMessage(message, field));
    }
  }
  return count;
}

void CheckOne(const std::string& argument) {
  const Settings settings = ParseSettings({argument});
  const auto& [path, value] = settings.front();
  FRESCO_CHECK(path + "=" + value == argument);
  proto::ExperimentConfig config;
  config.mutable_scenario()->add_sensor();
  SetField(config, path, value);
  FRESCO_CHECK(SetScalars(config) <= 1);
}

std::vector<std::string> LinesOf(std::string_view text) {
  std::vector<std::string> lines;
  for (size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  lines.emplace_back(text);
  return lines;
}

}  // namespace
}  // namespace fresco

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace fresco;
  const std::vector<std::string> lines = LinesOf(TextOf(data, size));
  for (const std::string& line : lines) {
    Accepts([&] { CheckOne(line); });
  }
  Accepts([&] { FRESCO_CHECK(ParseRunId(lines.back()) != 0); });
  Accepts([&] { Experiment::Parse("", "the defaults", ParseSettings(lines)); });
  return 0;
}
