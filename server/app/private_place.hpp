// SPDX-License-Identifier: GPL-3.0-or-later
//
// --private: a server for one client, in folders that go with it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/config.hpp"

namespace anticrack::app {

/// A data folder and a socket that only this user can reach, in new folders of TMPDIR (/tmp without
/// it), removed at the end. What such servers have left that were killed is removed at the start.
class PrivatePlace {
 public:
  /// The socket lies in XDG_RUNTIME_DIR or /tmp where TMPDIR is too long for one. Throws
  /// ConfigError, which names the variable, where no folder can be made.
  PrivatePlace();
  ~PrivatePlace();
  PrivatePlace(const PrivatePlace&) = delete;
  PrivatePlace& operator=(const PrivatePlace&) = delete;

  /// Where the server lives, for make_config: what the user says otherwise goes before.
  std::vector<Setting> settings() const;
  /// What removes all of it, also while threads still write to it; may be called when this is gone.
  std::function<void()> removal() const;

 private:
  class Folder;
  std::unique_ptr<Folder> _data;
  std::unique_ptr<Folder> _socket;  ///< none: in the other one
};

/// Returns when standard input has ended, which is when the client has, however it ended.
void wait_for_end_of_input();

}  // namespace anticrack::app
