/* A world for Fresco as a shared library (a plug-in): what the library has to export. Plain C, so it can be
 * written in any language. How to build and use one: examples/plugin.
 *
 * A library exports one function, fresco_world, which returns a table of functions. Fresco calls them as
 * follows, always on one thread at a time:
 *
 *   create -> describe -> (make -> reset -> step ... -> reset -> step ... -> release)* -> destroy
 *
 * There may be many environments at a time; they are stepped in turns.
 *
 * Determinism. An episode has to be a function of the settings, the seed and the actions: the same ones give
 * the same bits on every machine of a run. So draw random numbers from the seed only, read no clock, and
 * share nothing between environments. Only then are the weights of a run the same whatever happens.
 * `fresco-world check` tries it.
 *
 * Errors. A function that fails writes a text to `error` (at most `error_size` bytes, the closing zero
 * included) and returns null or 0. A failure, a crash, an exception, a value that is not allowed, or a call
 * that does not return in time (plugin.call_limit_s) ends the actor that made the call, with a message that
 * names the library and the function. The learner never runs the library's code. */
#ifndef FRESCO_WORLD_H
#define FRESCO_WORLD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this file. A library of another version is refused. */
#define FRESCO_WORLD_ABI_VERSION 2

/* A quantity for people. `name`: lower-case letters, digits and underscores, at most 63 characters, e.g.
 * "pole_angle". `unit`: e.g. "rad", at most 15 characters; null or "" if it has none. */
typedef struct fresco_quantity {
  const char* name;
  const char* unit;
} fresco_quantity;

/* What a world is. Everything that is pointed to has to live until destroy is called. */
typedef struct fresco_world_description {
  /* Kind of world, e.g. "cartpole"; as the name of a quantity. */
  const char* name;
  /* The state: what step and reset write, what messages carry and what the network sees. So scale it to about
   * unit size. 1 to 10000 fields. */
  int32_t state_size;
  const fresco_quantity* state;
  /* A name for each action, e.g. "push left"; at most 63 characters. 1 to 4000 actions. */
  int32_t action_count;
  const char* const* actions;
  /* Steps of the longest episode, 1 to 100000. Fresco cuts off an episode that is longer. */
  int32_t longest_episode;
  /* Discount of future rewards, 0 to 1, unless the configuration has agent.discount. */
  double discount;
  /* An episode's score is its return: the sum of its rewards. It succeeds if the return is at least so much.
   */
  double success_return;
  /* What an episode that succeeds does, e.g. "balanced"; as the name of a quantity. */
  const char* success;
  /* 1 if the seed decides nothing, so that one episode says everything about a policy; otherwise 0. */
  int32_t without_chance;
} fresco_world_description;

/* How a step ends an episode. */
enum {
  FRESCO_CONTINUES = 0,
  FRESCO_TERMINAL = 1, /* nothing more is earned from the new state on */
  FRESCO_TRUNCATED = 2 /* it was only long enough; the new state has a value like any other */
};

typedef struct fresco_world_functions {
  /* FRESCO_WORLD_ABI_VERSION. */
  uint32_t abi_version;

  /* Makes a world from the text plugin.settings of the configuration, which may be empty. Returns null if the
   * text is not allowed. */
  void* (*create)(const char* settings, char* error, size_t error_size);
  /* Frees the world. All of its environments have been released. */
  void (*destroy)(void* world);
  /* Says what the world is. Never null. */
  const fresco_world_description* (*describe)(const void* world);

  /* Makes an environment; returns null if it fails. */
  void* (*make)(const void* world, char* error, size_t error_size);
  /* Frees an environment. */
  void (*release)(void* environment);
  /* Begins the episode of `seed`. Writes the first state, `state_size` finite values, and 1 (allowed) or 0
   * for each action to `mask`, which holds ones before the call; at least one action has to be allowed.
   * Returns 1, or 0 if it fails. */
  int32_t (*reset)(void* environment, uint64_t seed, float* state, uint8_t* mask, char* error,
                   size_t error_size);
  /* Takes the action with this number, 0 to action_count - 1, which was allowed. Writes the reward (finite),
   * how the episode ends (FRESCO_CONTINUES before the call), and the new state and mask as reset does.
   * Returns 1, or 0 if it fails. */
  int32_t (*step)(void* environment, int32_t action, double* reward, int32_t* ending, float* state,
                  uint8_t* mask, char* error, size_t error_size);
} fresco_world_functions;

/* The library's only export. The table has to live as long as the library is loaded. */
#if defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const fresco_world_functions*
fresco_world(void);

#ifdef __cplusplus
}
#endif

#endif
