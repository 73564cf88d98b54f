// Acts as a training learned: `act runs/NAME` prints, for the UAV's world,
//   arrived; average AoI 13.357 slots, total AoI 2805, 13880 J left
#include <cstdio>
#include <exception>

#include "storage/trained_policy.h"
#include "worlds/episode.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: act RUN\n");
    return 2;
  }
  try {
    fresco::TrainedPolicy policy(argv[1]);
    fresco::EpisodeRecorder recorder(policy.world(), 0);
    while (!recorder.ended()) {
      recorder.Step(policy.Act(recorder.environment()));
    }
    std::printf("%s\n", policy.world().Tell(recorder.episode()).sentence.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "act: %s\n", error.what());
    return 1;
  }
}
