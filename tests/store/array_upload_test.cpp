// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/array_upload.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "support/errors.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::store {
namespace {

using anticrack::testing::error_of;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::throws;
using errors::Reason;

class ArrayUpload : public ::testing::Test {
 protected:
  std::string file(const std::vector<double>& values) const {
    return file(
        std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)));
  }
  std::string file(const std::string& bytes) const {
    const std::string path = (_folder / "array").string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

 private:
  TemporaryFolder _folder;
};

TEST_F(ArrayUpload, IsReadAsItWasWritten) {
  std::vector<double> values(20'000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::sin(static_cast<double>(i));
  }
  const std::string path = file(values);
  EXPECT_EQ(array_length(path), values.size());
  EXPECT_EQ(read_array(path), values);
}

/// What ArrayCheck says of values that come in pieces of so many bytes.
void check(const std::vector<double>& values, std::size_t piece) {
  ArrayCheck array;
  for (auto bytes = std::as_bytes(std::span(values)); !bytes.empty();) {
    const auto head = bytes.first(std::min(piece, bytes.size()));
    array.add(head);
    bytes = bytes.subspan(head.size());
  }
}

TEST_F(ArrayUpload, NamesTheValueThatIsNotFinite) {
  std::vector<double> values(20'000, 1.0);
  values[12'345] = std::nan("");
  const std::string path = file(values);
  for (const std::size_t piece : {0, 1, 13, 4096, 32768, 100'000, 1'000'000}) {
    const auto error =
        error_of([&] { piece == 0 ? (void)read_array(path) : check(values, piece); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->reason(), Reason::invalid_argument);
    EXPECT_NE(std::string(error->what()).find("value 12345"), std::string::npos) << error->what();
  }
}

TEST_F(ArrayUpload, IsCheckedWhileItArrivesInPiecesOfAnySize) {
  const std::vector<double> values(5'000, -0.5);
  for (const std::size_t piece : {1, 3, 8, 32767, 32768, 40'000}) {
    EXPECT_NO_THROW(check(values, piece)) << piece;
  }
}

TEST_F(ArrayUpload, IsReadInPartWhateverItHolds) {
  std::vector<double> values = {0, 1, 2, std::nan(""), 4, HUGE_VAL};
  const std::string path = file(values);
  EXPECT_EQ(read_array_part(path, 1, 2), (std::vector<double>{1, 2}));
  EXPECT_EQ(read_array_part(path, 4, 2), (std::vector<double>{4, HUGE_VAL}));
  EXPECT_TRUE(std::isnan(read_array_part(path, 3, 1).at(0)));
  EXPECT_TRUE(throws([&] { read_array_part(path, 5, 2); }, Reason::storage));
  EXPECT_TRUE(throws([&] { read_array_part(path, 1'000'000, 1); }, Reason::storage));
  EXPECT_TRUE(throws([&] { read_array_part("/nowhere/at/all", 0, 1); }, Reason::storage));
}

TEST_F(ArrayUpload, IsNoMshAndNoFractionOfAValue) {
  for (const std::string& bytes : {std::string("$MeshFormat\n2.2 0 8"), std::string("$MeshFormat"),
                                   std::string(), std::string(15, 'x')}) {
    const std::string path = file(bytes);
    EXPECT_TRUE(throws([&] { array_length(path); }, Reason::invalid_argument)) << bytes;
    EXPECT_TRUE(throws([&] { read_array(path); }, Reason::invalid_argument)) << bytes;
  }
  EXPECT_TRUE(throws([&] { array_length("/nowhere/at/all"); }, Reason::storage));
}

}  // namespace
}  // namespace anticrack::store
