// Everything that `fresco bench` measures: a function for each file with the rows of its subject.
#pragma once

#include <vector>

#include "tests/bench/rows.h"

namespace fresco {

std::vector<Subject> UpdateSubjects();
std::vector<Subject> EnvironmentSubjects();
std::vector<Subject> ActorSubjects();
std::vector<Subject> BusSubjects();
std::vector<Subject> TrainingSubjects();
std::vector<Subject> LogSubjects();
std::vector<Subject> PlannerSubjects();
std::vector<Subject> GrowthSubjects();

}  // namespace fresco
