// SPDX-License-Identifier: GPL-3.0-or-later
//
// The progress of the helper process, which it writes before its reply.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace anticrack::mesher {

struct Progress {
  std::string doing;            ///< "bisecting a mesh"
  std::uint64_t triangles = 0;  ///< so far; 0: not counted
};

/// The helper writes reports, then the reply; each begins with one of these bytes.
constexpr std::byte report_mark{'P'}, reply_mark{'R'};

/// A report as bytes.
std::vector<std::byte> encode(const Progress& progress);

/// The report at the beginning, and how many bytes it takes; none if it is not complete yet.
/// Characters that plain words do not have are left out, as they come from a process that reads
/// files of others.
std::optional<std::pair<Progress, std::size_t>> first_report(std::span<const std::byte> bytes);

}  // namespace anticrack::mesher
