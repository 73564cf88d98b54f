// The fields of every message by name, in the order of its .lcm file: for those who show or export messages.
// A type of MessageTypes that is missing here does not compile where it is shown; a field that is missing is
// found by tests/msgs/message_fields_test.cc. Pure.
#pragma once

#include "msgs/wire.h"

namespace fresco {

/// Calls visit(const char* name, const auto& value) for every field of the message. Values are integers,
/// floating-point numbers, texts, vectors of these or of order_t and chunk_range_t, and vectors of vectors.
template <class Visitor>
void ForEachField(const run_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("part_size", message.part_size);
  visit("part_index", message.part_index);
  visit("part_count", message.part_count);
  visit("protocol_version", message.protocol_version);
  visit("arithmetic_fingerprint", message.arithmetic_fingerprint);
  visit("inputs", message.inputs);
  visit("outputs", message.outputs);
  visit("parameters", message.parameters);
  visit("values_per_chunk", message.values_per_chunk);
  visit("current_version", message.current_version);
  visit("target_version", message.target_version);
  visit("finished", message.finished);
  visit("part", message.part);
}

template <class Visitor>
void ForEachField(const order_t& order, Visitor&& visit) {
  visit("index", order.index);
  visit("actor_id", order.actor_id);
  visit("attempt", order.attempt);
  visit("kind", order.kind);
  visit("epsilon", order.epsilon);
  visit("seed", order.seed);
  visit("current_version", order.current_version);
  visit("target_version", order.target_version);
}

template <class Visitor>
void ForEachField(const orders_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("order_count", message.order_count);
  visit("committed_orders", message.committed_orders);
  visit("orders", message.orders);
}

template <class Visitor>
void ForEachField(const transitions_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("transition_count", message.transition_count);
  visit("state_count", message.state_count);
  visit("sensor_count", message.sensor_count);
  visit("mask_size", message.mask_size);
  visit("order_index", message.order_index);
  visit("actor_id", message.actor_id);
  visit("first_transition", message.first_transition);
  visit("outcome", message.outcome);
  visit("column", message.column);
  visit("row", message.row);
  visit("time_margin", message.time_margin);
  visit("energy_margin_j", message.energy_margin_j);
  visit("aoi", message.aoi);
  visit("action", message.action);
  visit("reward", message.reward);
  visit("td_error", message.td_error);
  visit("next_mask", message.next_mask);
}

template <class Visitor>
void ForEachField(const weights_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("value_count", message.value_count);
  visit("version", message.version);
  visit("offset", message.offset);
  visit("total_values", message.total_values);
  visit("crc32c", message.crc32c);
  visit("values", message.values);
}

template <class Visitor>
void ForEachField(const chunk_range_t& range, Visitor&& visit) {
  visit("network", range.network);
  visit("version", range.version);
  visit("first", range.first);
  visit("count", range.count);
}

template <class Visitor>
void ForEachField(const actor_status_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("held_count", message.held_count);
  visit("missing_count", message.missing_count);
  visit("actor_id", message.actor_id);
  visit("sequence", message.sequence);
  visit("pid", message.pid);
  visit("capacity", message.capacity);
  visit("open_orders", message.open_orders);
  visit("oldest_open_order", message.oldest_open_order);
  visit("arithmetic_fingerprint", message.arithmetic_fingerprint);
  visit("episodes", message.episodes);
  visit("transitions", message.transitions);
  visit("resent_episodes", message.resent_episodes);
  visit("rejected_messages", message.rejected_messages);
  visit("transitions_per_s", message.transitions_per_s);
  visit("weights_latency_ms", message.weights_latency_ms);
  visit("host", message.host);
  visit("held", message.held);
  visit("missing", message.missing);
}

template <class Visitor>
void ForEachField(const learner_status_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("committed_orders", message.committed_orders);
  visit("episodes", message.episodes);
  visit("total_episodes", message.total_episodes);
  visit("transitions", message.transitions);
  visit("updates", message.updates);
  visit("replay_size", message.replay_size);
  visit("current_version", message.current_version);
  visit("target_version", message.target_version);
  visit("orders_in_flight", message.orders_in_flight);
  visit("actors", message.actors);
  visit("epsilon", message.epsilon);
  visit("learning_rate", message.learning_rate);
  visit("loss", message.loss);
  visit("average_aoi", message.average_aoi);
  visit("best_average_aoi", message.best_average_aoi);
  visit("arrived", message.arrived);
  visit("lower_bound_average_aoi", message.lower_bound_average_aoi);
  visit("optimum_proved", message.optimum_proved);
  visit("gap_percent", message.gap_percent);
  visit("staleness_updates", message.staleness_updates);
  visit("transitions_per_s", message.transitions_per_s);
  visit("updates_per_s", message.updates_per_s);
  visit("received", message.received);
  visit("duplicate", message.duplicate);
  visit("rejected", message.rejected);
  visit("lost", message.lost);
  visit("reordered_episodes", message.reordered_episodes);
  visit("waiting_for", message.waiting_for);
  visit("warning", message.warning);
}

template <class Visitor>
void ForEachField(const flight_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("sensor_count", message.sensor_count);
  visit("flight", message.flight);
  visit("slot", message.slot);
  visit("slots", message.slots);
  visit("column", message.column);
  visit("row", message.row);
  visit("time_margin", message.time_margin);
  visit("energy_margin_j", message.energy_margin_j);
  visit("remaining_energy_j", message.remaining_energy_j);
  visit("move", message.move);
  visit("scheduled", message.scheduled);
  visit("reward", message.reward);
  visit("total_aoi", message.total_aoi);
  visit("outcome", message.outcome);
  visit("policy", message.policy);
  visit("aoi", message.aoi);
}

template <class Visitor>
void ForEachField(const scenario_t& message, Visitor&& visit) {
  visit("utime", message.utime);
  visit("run_id", message.run_id);
  visit("config_hash", message.config_hash);
  visit("sensor_count", message.sensor_count);
  visit("first_sensor", message.first_sensor);
  visit("total_sensors", message.total_sensors);
  visit("columns", message.columns);
  visit("rows", message.rows);
  visit("cell_m", message.cell_m);
  visit("start_column", message.start_column);
  visit("start_row", message.start_row);
  visit("stop_column", message.stop_column);
  visit("stop_row", message.stop_row);
  visit("slots", message.slots);
  visit("slot_s", message.slot_s);
  visit("coverage_radius_m", message.coverage_radius_m);
  visit("initial_energy_j", message.initial_energy_j);
  visit("maximum_aoi", message.maximum_aoi);
  visit("x_m", message.x_m);
  visit("y_m", message.y_m);
  visit("weight", message.weight);
}

}  // namespace fresco
