// SPDX-License-Identifier: GPL-3.0-or-later
//
// For targets that parse messages: protobuf says nothing of the texts that are not UTF-8.
#pragma once

#include <google/protobuf/stubs/logging.h>

extern "C" __attribute__((used)) inline int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  google::protobuf::SetLogHandler(nullptr);
  return 0;
}
