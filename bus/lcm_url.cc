#include "bus/lcm_url.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>
#include <map>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace fresco {
namespace {

constexpr char kExample[] = "udpm://239.255.76.67:7667?ttl=0";

[[noreturn]] void Refuse(const std::string& url, const std::string& problem) {
  throw UsageError(fmt::format("LCM URL \"{}\": {}; for example: {}", url, problem, kExample));
}

std::optional<int64_t> ToInteger(const std::string& text) {
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Returns the number without leading zeros, since LCM would read 010 as eight, as C does.
std::string CheckInteger(const std::string& url, const std::string& name, const std::string& text,
                         int64_t minimum, int64_t maximum) {
  const auto value = ToInteger(text);
  if (!value || *value < minimum || *value > maximum) {
    Refuse(url, fmt::format("{}: expected {} to {}, found \"{}\"", name, minimum, maximum, text));
  }
  return std::to_string(*value);
}

std::map<std::string, std::string> ParseOptions(const std::string& url, const std::string& text) {
  std::map<std::string, std::string> options;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('&', begin), text.size());
    const std::string option = text.substr(begin, end - begin);
    const size_t equals = option.find('=');
    if (equals == std::string::npos) {
      Refuse(url, fmt::format("expected option=value, found \"{}\"", option));
    }
    options[option.substr(0, equals)] = option.substr(equals + 1);
    begin = end + 1;
  }
  return options;
}

/// Checks host:port (or group:port) and returns it in the form that LCM gets.
std::string CheckAddress(const std::string& url, const std::string& address, bool multicast) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) {
    Refuse(url, fmt::format("expected {}:port, found \"{}\"", multicast ? "group" : "host", address));
  }
  const std::string port = CheckInteger(url, "port", address.substr(colon + 1), 1, 65535);
  const std::string group = address.substr(0, colon);
  in_addr parsed{};
  if (multicast && (inet_pton(AF_INET, group.c_str(), &parsed) != 1 || (ntohl(parsed.s_addr) >> 28) != 0xE)) {
    Refuse(url, fmt::format("expected a multicast group, 224.0.0.0 to 239.255.255.255, found \"{}\"", group));
  }
  return group + ":" + port;
}

std::string NormalizeUdpm(const std::string& url, const std::string& address,
                          const std::string& option_text) {
  std::string normalized = "udpm://" + CheckAddress(url, address, true);
  auto options = ParseOptions(url, option_text);
  options.try_emplace("ttl", "0");
  options.try_emplace("recv_buf_size", "4194304");
  char separator = '?';
  for (const auto& [name, text] : options) {
    std::string value;
    if (name == "ttl") {
      value = CheckInteger(url, name, text, 0, 255);
    } else if (name == "recv_buf_size") {
      value = CheckInteger(url, name, text, 1, int64_t{1} << 30);
    } else {
      Refuse(url, fmt::format("unknown option \"{}\"; allowed: ttl, recv_buf_size", name));
    }
    normalized += separator + name + "=" + value;
    separator = '&';
  }
  return normalized;
}

}  // namespace

std::string NormalizeLcmUrl(const std::string& url) {
  const size_t scheme_end = url.find("://");
  const std::string scheme = url.substr(0, scheme_end == std::string::npos ? 0 : scheme_end);
  if (scheme != "udpm" && scheme != "tcpq" && scheme != "memq") {
    Refuse(url, fmt::format("expected udpm://group:port, tcpq://host:port or memq://, found scheme \"{}\"{}",
                            scheme, scheme == "file" ? " (file:// is for logs, not for a live run)" : ""));
  }
  const std::string rest = url.substr(scheme_end + 3);
  const size_t question = std::min(rest.find('?'), rest.size());
  const std::string address = rest.substr(0, question);
  const std::string options = question < rest.size() ? rest.substr(question + 1) : "";
  if (scheme == "udpm") {
    return NormalizeUdpm(url, address, options);
  }
  if (!options.empty() || (scheme == "memq" && !address.empty())) {
    Refuse(url, fmt::format("{}:// takes {}", scheme, scheme == "memq" ? "nothing after it" : "no options"));
  }
  return scheme == "tcpq" ? "tcpq://" + CheckAddress(url, address, false) : url;
}

std::optional<MulticastEndpoint> MulticastEndpointOf(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) {
    return std::nullopt;
  }
  const size_t question = url.find('?');
  const std::string address = url.substr(kScheme.size(), question - kScheme.size());
  const size_t colon = address.rfind(':');
  const auto options = ParseOptions(url, url.substr(question + 1));
  return MulticastEndpoint{address.substr(0, colon),
                           static_cast<uint16_t>(ToInteger(address.substr(colon + 1)).value()),
                           static_cast<int>(ToInteger(options.at("recv_buf_size")).value())};
}

}  // namespace fresco
