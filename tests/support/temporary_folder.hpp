// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace anticrack::testing {

/// A new empty folder, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : _path((std::filesystem::temp_directory_path() / "anticrack-test-XXXXXX").string()) {
    if (mkdtemp(_path.data()) == nullptr) {
      throw std::runtime_error("cannot make " + _path);
    }
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(_path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return _path; }
  std::filesystem::path operator/(const std::string& name) const {
    return std::filesystem::path(_path) / name;
  }

 private:
  std::string _path;
};

}  // namespace anticrack::testing
