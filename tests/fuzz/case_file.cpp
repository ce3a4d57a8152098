// SPDX-License-Identifier: GPL-3.0-or-later
//
// The client's case parser: pieces of overrides are lines of the form "#set KEY=VALUE" at the head
// of the text.
#include <google/protobuf/util/message_differencer.h>

#include <string>
#include <vector>

#include "casefile/case.hpp"
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
  const std::vector<std::string> overrides = take_overrides(text);
  casefile::Case read;
  try {
    read = casefile::parse_case(text, "case.toml", overrides);
  } catch (const casefile::Error&) {
    return 0;
  }
  read.locate("geometry.interfaces[0].points[1]");
  read.locate("load_cases[0].force.expression");
  // what is kept in the result file is the case as it was run
  const casefile::Case again = casefile::parse_case(read.text, "case.toml");
  fuzz::require(same(read.mesh, again.mesh), "the mesh request of the text kept is another");
  fuzz::require(same(read.job, again.job), "the job of the text kept is another");
  return 0;
}
