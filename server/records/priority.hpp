// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::records {

/// Which jobs go first. A job that has waited long counts as more urgent (jobs/schedule.hpp).
enum class Priority { interactive = 1, normal, bulk };

}  // namespace anticrack::records
