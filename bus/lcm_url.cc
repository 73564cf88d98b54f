#include "bus/lcm_url.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>
#include <map>

#include "core/error.h"

namespace fresco {
namespace {

constexpr char kExample[] = "udpm://239.255.76.67:7667?ttl=0";

[[noreturn]] void Refuse(const std::string& url, const std::string& problem) {
  throw UsageError(fmt::format("LCM URL \"{}\": {}; for example: {}", url, problem, kExample));
}

/// LCM would read 010 as eight, as C does; here it is ten.
int64_t ParseInteger(const std::string& url, const std::string& name, const std::string& text,
                     int64_t minimum, int64_t maximum) {
  int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < minimum || value > maximum) {
    Refuse(url, fmt::format("{}: expected {} to {}, found \"{}\"", name, minimum, maximum, text));
  }
  return value;
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

struct Address {
  std::string host;  // or a multicast group
  int64_t port;
};

Address ParseAddress(const std::string& url, const std::string& address, bool multicast) {
  const size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) {
    Refuse(url, fmt::format("expected {}:port, found \"{}\"", multicast ? "group" : "host", address));
  }
  const int64_t port = ParseInteger(url, "port", address.substr(colon + 1), 1, 65535);
  const std::string host = address.substr(0, colon);
  in_addr parsed{};
  if (multicast && (inet_pton(AF_INET, host.c_str(), &parsed) != 1 || (ntohl(parsed.s_addr) >> 28) != 0xE)) {
    Refuse(url, fmt::format("expected a multicast group, 224.0.0.0 to 239.255.255.255, found \"{}\"", host));
  }
  return {host, port};
}

LcmUrl ParseUdpm(const std::string& url, const std::string& address, const std::string& options) {
  const auto [group, port] = ParseAddress(url, address, true);
  int64_t ttl = 0;
  int64_t receive_buffer_bytes = 4'194'304;
  for (const auto& [name, text] : ParseOptions(url, options)) {
    if (name == "ttl") {
      ttl = ParseInteger(url, name, text, 0, 255);
    } else if (name == "recv_buf_size") {
      receive_buffer_bytes = ParseInteger(url, name, text, 1, int64_t{1} << 30);
    } else {
      Refuse(url, fmt::format("unknown option \"{}\"; allowed: ttl, recv_buf_size", name));
    }
  }
  return {fmt::format("udpm://{}:{}?recv_buf_size={}&ttl={}", group, port, receive_buffer_bytes, ttl),
          MulticastEndpoint{group, static_cast<uint16_t>(port), static_cast<int>(receive_buffer_bytes),
                            static_cast<int>(ttl)}};
}

}  // namespace

LcmUrl ParseLcmUrl(const std::string& url) {
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
    return ParseUdpm(url, address, options);
  }
  if (!options.empty() || (scheme == "memq" && !address.empty())) {
    Refuse(url, fmt::format("{}:// takes {}", scheme, scheme == "memq" ? "nothing after it" : "no options"));
  }
  if (scheme == "memq") {
    return {url};
  }
  const auto [host, port] = ParseAddress(url, address, false);
  return {fmt::format("tcpq://{}:{}", host, port)};
}

}  // namespace fresco
