// SPDX-License-Identifier: GPL-3.0-or-later
//
// The reader of cases: TOML, or JSON where the text begins with a brace; overrides are lines of the
// form
// "#set KEY=VALUE" at its head.
#include <google/protobuf/util/message_differencer.h>

#include <string>
#include <utility>
#include <vector>

#include "casefile/read_case.hpp"
#include "errors/errors.hpp"
#include "fuzz/input.hpp"

namespace {

using namespace anticrack;

bool same(const google::protobuf::Message& a, const google::protobuf::Message& b) {
  google::protobuf::util::MessageDifferencer differencer;
  google::protobuf::util::DefaultFieldComparator comparator;
  comparator.set_treat_nan_as_equal(true);
  differencer.set_field_comparator(&comparator);
  return differencer.Compare(a, b);
}

std::vector<std::string> take_overrides(std::string& text) {
  const std::string mark = "#set ";
  std::vector<std::string> overrides;
  while (text.starts_with(mark) && overrides.size() < 8) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    overrides.push_back(text.substr(mark.size(), end - mark.size()));
    text.erase(0, end + 1);
  }
  return overrides;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(fuzz::text_of(data, size));
  v1::ReadCaseRequest request;
  for (std::string& override : take_overrides(text)) request.add_overrides(std::move(override));
  request.set_source("case");
  if (text.starts_with('{'))
    request.set_json(text);
  else
    request.set_toml(text);
  v1::ReadCaseResponse read;
  try {
    read = casefile::read_case(request, {});
  } catch (const errors::Error&) {
    return 0;
  }
  if (read.toml().empty()) return 0;
  // what is kept in the result file is the case as it was run
  v1::ReadCaseRequest again;
  again.set_toml(read.toml());
  const v1::ReadCaseResponse kept = casefile::read_case(again, {});
  fuzz::require(same(read.mesh(), kept.mesh()), "the mesh request of the text kept is another");
  fuzz::require(same(read.spec(), kept.spec()), "the job of the text kept is another");
  return 0;
}
