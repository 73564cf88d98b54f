#include "msgs/field_names.h"

#include "core/error.h"

namespace fresco {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::FieldDescriptor;

/// Returns the quoted text that follows `before`: x of before"x". Returns "" if there is none.
std::string QuotedAfter(const std::string& before, const std::string& text) {
  const size_t found = text.find(before + "\"");
  if (found == std::string::npos) {
    return "";
  }
  const size_t begin = found + before.size() + 1;
  return text.substr(begin, text.find('"', begin) - begin);
}

}  // namespace

std::vector<std::string> FieldPaths(const Descriptor& message) {
  std::vector<std::string> paths;
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      paths.push_back(field.name());
      continue;
    }
    for (const std::string& below : FieldPaths(*field.message_type())) {
      paths.push_back(field.name() + (field.is_repeated() ? "[0]." : ".") + below);
    }
  }
  return paths;
}

std::vector<std::string> FieldNames(const Descriptor& message) {
  std::vector<std::string> names;
  for (int i = 0; i < message.field_count(); ++i) {
    names.push_back(message.field(i)->name());
  }
  return names;
}

std::string DidYouMeanField(const std::string& protobuf_error) {
  const std::string message_name = QuotedAfter("Message type ", protobuf_error);
  const std::string field_name = QuotedAfter(" has no field named ", protobuf_error);
  const Descriptor* message = DescriptorPool::generated_pool()->FindMessageTypeByName(message_name);
  return message == nullptr ? "" : DidYouMean(field_name, FieldNames(*message));
}

}  // namespace fresco
