// Joins the parts of one episode as they come, in any order and also twice. Plain memory; only one thread at
// a time may use an object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "msgs/order.h"
#include "worlds/world.h"

namespace fresco {

class EpisodeAssembly {
 public:
  /// `world` must outlive the object.
  explicit EpisodeAssembly(const World& world);

  /// The memory of an object, its own size included, bytes.
  static int64_t BytesFor(const World& world);

  enum class Arrival {
    kNew,            ///< the part has something that had not arrived
    kNothingNew,     ///< the part repeats what is here
    kContradiction,  ///< a value, the length or the ending differs from what is here; use the object no more
  };
  /// Adds a part that FromWire accepted. Every part with the last transition has to say that the episode ends
  /// there, and how.
  Arrival Add(const OrderResult& part);
  /// Forgets everything, also after a contradiction. Leaves the room for another episode.
  void Clear();

  /// Whether everything has arrived.
  bool complete() const { return length_ > 0 && parts_arrived_ == length_ * field_parts_; }
  /// What has arrived; the rest is 0.
  const Episode& episode() const { return episode_; }

 private:
  bool EndFits(const OrderResult& part, size_t end) const;
  void MakeRoom(size_t transitions);
  bool MergeTransition(const OrderResult& part, size_t i);
  bool MergeState(const OrderResult& part, size_t i);
  bool IsHere(size_t transition, size_t field_part) const {
    return transition < episode_.actions.size() && arrived_[transition * field_parts_ + field_part] != 0;
  }
  bool AnyIsHere(size_t transition) const;
  size_t FieldPart(const OrderResult& part) const {
    return static_cast<size_t>(part.first_field) / fields_a_part_;
  }

  size_t state_size_;
  size_t mask_size_;
  size_t fields_a_part_;
  size_t field_parts_;  // parts that have the same transition
  Episode episode_;
  std::vector<uint8_t> arrived_;  // by transition and part of the fields: 1 if it is here
  size_t parts_arrived_ = 0;      // the number of ones in arrived_
  size_t length_ = 0;             // of the episode; 0 before a part that ends it has arrived
};

}  // namespace fresco
