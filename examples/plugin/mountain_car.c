/* Mountain car (Moore 1990; Sutton and Barto, example 10.1) as a plug-in for Fresco: an engine that is too weak
 * for the slope has to swing the car to the top. Settings: "delay_ms=2" makes every step wait, as a robot's
 * simulator does; omitted: no delay. */
#include <fresco/world.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { LONGEST_EPISODE = 200 };
static const double LEFT_END = -1.2, GOAL = 0.5, MAXIMUM_SPEED = 0.07;

struct world {
  int delay_ms;
};

struct environment {
  const struct world* world;
  double position; /* -1.2 to 0.6 */
  double speed;    /* a step, -0.07 to 0.07 */
};

static const fresco_quantity kState[] = {{"scaled_position", ""}, {"scaled_speed", ""}};
static const char* const kActions[] = {"push left", "coast", "push right"};
static const fresco_world_description kDescription = {
    .name = "mountain_car",
    .state_size = 2,
    .state = kState,
    .action_count = 3,
    .actions = kActions,
    .longest_episode = LONGEST_EPISODE,
    .discount = 0.99,
    .success_return = -(LONGEST_EPISODE - 1),
    .success = "reached_the_top",
};

static void* Create(const char* settings, char* error, size_t error_size) {
  int delay_ms = 0;
  char rest = 0;
  if (*settings != 0 && (sscanf(settings, "delay_ms=%d%c", &delay_ms, &rest) != 1 || delay_ms < 0)) {
    snprintf(error, error_size, "expected nothing or delay_ms=N, found \"%s\"", settings);
    return NULL;
  }
  struct world* world = malloc(sizeof *world);
  world->delay_ms = delay_ms;
  return world;
}

static void Destroy(void* world) { free(world); }

static const fresco_world_description* Describe(const void* world) {
  (void)world;
  return &kDescription;
}

static void* Make(const void* world, char* error, size_t error_size) {
  (void)error, (void)error_size;
  struct environment* environment = calloc(1, sizeof *environment);
  environment->world = world;
  return environment;
}

static void Release(void* environment) { free(environment); }

static void WriteState(const struct environment* environment, float* state) {
  state[0] = (float)((environment->position + 0.3) / 0.9);
  state[1] = (float)(environment->speed / MAXIMUM_SPEED);
}

/* A well-mixed number from a seed (the finaliser of SplitMix64). */
static uint64_t Mix(uint64_t seed) {
  seed += 0x9e3779b97f4a7c15u;
  seed = (seed ^ (seed >> 30)) * 0xbf58476d1ce4e5b9u;
  seed = (seed ^ (seed >> 27)) * 0x94d049bb133111ebu;
  return seed ^ (seed >> 31);
}

static int32_t Reset(void* pointer, uint64_t seed, float* state, uint8_t* mask, char* error, size_t error_size) {
  (void)mask, (void)error, (void)error_size;
  struct environment* environment = pointer;
  environment->position = -0.6 + 0.2 * (double)(Mix(seed) >> 11) / 9007199254740992.0;
  environment->speed = 0;
  WriteState(environment, state);
  return 1;
}

static int32_t Step(void* pointer, int32_t action, double* reward, int32_t* ending, float* state, uint8_t* mask,
                    char* error, size_t error_size) {
  (void)mask, (void)error, (void)error_size;
  struct environment* environment = pointer;
  if (environment->world->delay_ms > 0) {
    const struct timespec delay = {environment->world->delay_ms / 1000,
                                   environment->world->delay_ms % 1000 * 1000000L};
    nanosleep(&delay, NULL);
  }
  environment->speed += 0.001 * (action - 1) - 0.0025 * cos(3 * environment->position);
  environment->speed = fmin(fmax(environment->speed, -MAXIMUM_SPEED), MAXIMUM_SPEED);
  environment->position += environment->speed;
  if (environment->position <= LEFT_END) {
    environment->position = LEFT_END;
    environment->speed = 0;
  }
  *reward = -1;
  *ending = environment->position >= GOAL ? FRESCO_TERMINAL : FRESCO_CONTINUES;
  WriteState(environment, state);
  return 1;
}

const fresco_world_functions* fresco_world(void) {
  static const fresco_world_functions functions = {
      FRESCO_WORLD_ABI_VERSION, Create, Destroy, Describe, Make, Release, Reset, Step,
  };
  return &functions;
}
