// Reads what a study needs from a run's folder: its result, or what is needed to resume it. Changes nothing;
// any thread may call these functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "report/study.h"
#include "storage/checkpoint_folder.h"

namespace fresco {

/// Returns the result of the run in `folder` from its summary (JSON). Throws Failure if the search for its
/// optimum failed.
StudyResult ResultOf(const std::string& summary, const std::filesystem::path& folder);

// The following functions throw UsageError if the folder holds a run with another configuration than the
// job's.

/// Returns the result of a finished run (IsFinished); none if it still has to be run or resumed.
std::optional<StudyResult> CompleteResult(const std::filesystem::path& folder, const StudyJob& job);

/// Returns what is needed to resume a run that was interrupted; none if it has no checkpoint. Also throws
/// UsageError if it has checkpoints but none can be read.
std::optional<Resumption> InterruptedRun(const std::filesystem::path& folder, const StudyJob& job);

}  // namespace fresco
