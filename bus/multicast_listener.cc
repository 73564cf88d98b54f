#include "bus/multicast_listener.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <utility>

#include "core/clock.h"
#include "core/error.h"

namespace fresco {
namespace {

// The limit of the memory for messages that wait for a handler that is slower than the network, and the
// overhead of each message. Beyond it, messages stay in the kernel's buffer. If that is full, the kernel
// drops and counts them.
constexpr size_t kMaximumArrivedBytes = size_t{128} << 20;
constexpr size_t kArrivedOverheadBytes = 128;

}  // namespace

EventDescriptor::EventDescriptor() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  FRESCO_CHECK(descriptor_ >= 0);
}

EventDescriptor::~EventDescriptor() {
  close(descriptor_);
}

void EventDescriptor::Set() {
  eventfd_write(descriptor_, 1);
}

void EventDescriptor::Clear() {
  eventfd_t value = 0;
  eventfd_read(descriptor_, &value);
}

MulticastListener::MulticastListener(const MulticastEndpoint& endpoint)
    : socket_(endpoint), thread_([this](const std::stop_token& stop) { Listen(stop); }) {}

bool MulticastListener::Hears(const std::string& channel, const std::function<void()>& send) {
  constexpr int64_t kPatienceUs = 10'000'000;
  constexpr int kSendAgainMs = 100;
  bool heard = false;
  const auto listen = [&](const LcmEvent& event) { heard = event.channel == channel; };
  const int64_t deadline_us = MonotonicMicroseconds() + kPatienceUs;
  while (!heard && MonotonicMicroseconds() < deadline_us) {
    send();
    const int64_t send_again_us = MonotonicMicroseconds() + 1000 * kSendAgainMs;
    while (!heard && MonotonicMicroseconds() < send_again_us) {
      pollfd readable{descriptor(), POLLIN, 0};
      poll(&readable, 1, has_left_over() ? 0 : kSendAgainMs);
      HandOut(listen, 1);
    }
  }
  handed_out_ = 0;
  return heard;
}

int MulticastListener::HandOut(const BusEventHandler& handler, int maximum) {
  if (taken_.empty()) {
    const std::lock_guard lock(mutex_);
    arrival_.Clear();
    std::swap(taken_, arrived_);
    arrived_bytes_ = 0;
    room_.notify_all();
  }
  int count = 0;
  while (count < maximum && !taken_.empty()) {
    const auto [utime, message] = std::move(taken_.front());
    taken_.pop_front();
    ++count;
    handler({handed_out_++, utime, message.channel, message.content});
  }
  return count;
}

UnheardTraffic MulticastListener::unheard() const {
  const std::lock_guard lock(mutex_);
  return unheard_;
}

/// The function of the listening thread.
void MulticastListener::Listen(const std::stop_token& stop) {
  const std::stop_callback wake(stop, [this] { end_.Set(); });
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> readable = {{{socket_.descriptor(), POLLIN, 0}, {end_.descriptor(), POLLIN, 0}}};
    poll(readable.data(), readable.size(), -1);
    socket_.Receive([this](const ReceivedDatagram& received) { Assemble(received); });
    std::unique_lock lock(mutex_);
    room_.wait(lock, stop, [this] { return arrived_bytes_ < kMaximumArrivedBytes; });
  }
}

void MulticastListener::Assemble(const ReceivedDatagram& received) {
  auto message = assembler_.Add(received.datagram, received.sender, received.utime);
  const std::lock_guard lock(mutex_);
  unheard_ = {assembler_.refused_datagrams(), assembler_.incomplete_messages()};
  if (message) {
    arrived_bytes_ += message->content.size() + kArrivedOverheadBytes;
    if (arrived_.empty()) {
      arrival_.Set();
    }
    arrived_.push_back({received.utime, std::move(*message)});
  }
}

}  // namespace fresco
