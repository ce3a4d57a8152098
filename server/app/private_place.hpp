// SPDX-License-Identifier: GPL-3.0-or-later
//
// The option --private: a server for one client, in folders that are removed with it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// A data folder and a socket that only this user can reach, in new folders of TMPDIR (/tmp without
/// it), removed at the end. Folders that killed servers have left are removed at the start.
class PrivatePlace {
 public:
  /// The socket lies in XDG_RUNTIME_DIR or /tmp if the path of TMPDIR is too long for it. Throws
  /// ConfigError with the name of the variable if no folder can be made.
  PrivatePlace();
  ~PrivatePlace();
  PrivatePlace(const PrivatePlace&) = delete;
  PrivatePlace& operator=(const PrivatePlace&) = delete;

  /// The settings of this place, for make_config; settings of the user override them.
  std::vector<Setting> settings() const;
  /// A function that removes everything, even while threads still write to it. It may be called
  /// after this object was destroyed.
  std::function<void()> removal() const;

 private:
  class Folder;
  std::unique_ptr<Folder> _data;
  std::unique_ptr<Folder> _socket;  ///< null: the socket is in _data
};

/// Returns when standard input has ended, which happens when the client ends, however it ends.
void wait_for_end_of_input();

}  // namespace anticrack::app
