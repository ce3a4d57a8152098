// SPDX-License-Identifier: GPL-3.0-or-later
#include "records/job_record.hpp"

#include "records/case_record.hpp"

namespace anticrack::records {

// Here, where a CaseRecord is known.
JobRecord::JobRecord() = default;
JobRecord::JobRecord(const JobRecord& other) = default;
JobRecord::JobRecord(JobRecord&& other) noexcept = default;
JobRecord& JobRecord::operator=(const JobRecord& other) = default;
JobRecord& JobRecord::operator=(JobRecord&& other) noexcept = default;
JobRecord::~JobRecord() = default;

}  // namespace anticrack::records
