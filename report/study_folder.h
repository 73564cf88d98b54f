// What a study finds in a run's folder: its result, or what to go on from. Reads only.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "report/study.h"
#include "storage/resumption.h"

namespace fresco {

/// What the summary (JSON) of the run in `folder` says. Throws Failure where the search for its optimum
/// failed.
StudyResult ResultOf(const std::string& summary, const std::filesystem::path& folder);

// Both throw UsageError where the folder holds a run of another configuration than the job's.

/// Of a run of which nothing is left to do (IsFinished); none if it has to be run, or run on.
std::optional<StudyResult> CompleteResult(const std::filesystem::path& folder, const StudyJob& job);

/// Of a run that an interrupted study left; none where it left no checkpoint. Throws UsageError also where
/// none of its checkpoints can be read.
std::optional<Resumption> InterruptedRun(const std::filesystem::path& folder, const StudyJob& job);

}  // namespace fresco
