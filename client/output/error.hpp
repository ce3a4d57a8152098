// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace anticrack::output {

/// The error of a file that cannot be written, read or understood: what() is "SUBJECT: CAUSE;
/// CURE".
class Error : public std::runtime_error {
 public:
  Error(const std::string& subject, const std::string& cause, const std::string& cure)
      : std::runtime_error(subject + ": " + cause + (cure.empty() ? "" : "; " + cure)),
        _subject(subject),
        _cause(cause),
        _cure(cure) {}

  const std::string& subject() const noexcept {
    return _subject;
  }  ///< the path, or the data's
     ///< source
  const std::string& cause() const noexcept { return _cause; }
  const std::string& cure() const noexcept { return _cure; }  ///< may be empty

 private:
  std::string _subject, _cause, _cure;
};

}  // namespace anticrack::output
