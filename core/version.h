// The software's version, written into files and shown by --version.
#pragma once

namespace fresco {

inline constexpr char kSoftwareVersion[] = "0.1.0";

}  // namespace fresco
