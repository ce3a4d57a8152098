// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <utility>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

/// Keeps the memory of a file of the core driver when the file is closed. H5Fget_file_image would
/// read an open file, which in HDF5 1.10.8 leaves a wrong checksum in the superblock.
struct Kept {
  Kept() = default;
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;
  ~Kept() { std::free(memory); }

  /// With malloc and realloc of HDF5's own.
  H5FD_file_image_callbacks_t callbacks() {
    const auto keep = [](void* bytes, H5FD_file_image_op_t, void* self) {
      std::free(std::exchange(static_cast<Kept*>(self)->memory, bytes));
      return herr_t{0};
    };
    // HDF5 copies the property list; all copies share this one memory.
    const auto same = [](void* self) { return self; };
    const auto forget = [](void*) { return herr_t{0}; };
    return {nullptr, nullptr, nullptr, keep, same, forget, this};
  }

  void* memory = nullptr;
};

/// HDF5 searches and sorts its metadata cache, which is of no use as the file is in memory anyway:
/// a cache of 64 KiB, not 2 MiB and more, writes a file of 200 loads in three quarters of the time.
void set_small_cache(const Handle& access) {
  H5AC_cache_config_t cache;
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  const herr_t got = H5Pget_mdc_config(access.get(), &cache);
  cache.set_initial_size = true;
  cache.initial_size = cache.min_size = cache.max_size = 1 << 16;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  if (got < 0 || H5Pset_mdc_config(access.get(), &cache) < 0)
    throw Fault("HDF5 has no settings for its cache");
}

}  // namespace

std::vector<std::byte> file_image(const std::function<void(const Handle& root)>& fill) {
  constexpr std::size_t increment = 1 << 20;
  Kept kept;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "HDF5 does not start");
  H5FD_file_image_callbacks_t callbacks = kept.callbacks();
  if (H5Pset_fapl_core(access.get(), increment, false) < 0 ||
      H5Pset_file_image_callbacks(access.get(), &callbacks) < 0)
    throw Fault("HDF5 has no core driver");
  // Formats since 1.10 have checksums on all metadata; a damaged file of an older format can make
  // the library read outside its buffers.
  if (H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) < 0)
    throw Fault("HDF5 is older than 1.10");
  set_small_cache(access);
  // Chunks are written whole and once: each dataset needs no table of 521 of them.
  if (H5Pset_cache(access.get(), 0, 1, increment, 1) < 0) throw Fault("HDF5 takes no cache");
  const Handle creation = without_times(H5P_FILE_CREATE);
  Handle file(H5Fcreate("result", H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
              "HDF5 cannot create a file in memory");
  fill({H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group"});
  const bool flushed = H5Fflush(file.get(), H5F_SCOPE_LOCAL) >= 0;
  const ssize_t size = H5Fget_file_image(file.get(), nullptr, 0);
  if (!flushed || size < 0) throw Fault("HDF5 cannot write the file");
  file.close_now("HDF5 cannot finish the file");
  const auto* first = static_cast<const std::byte*>(kept.memory);
  return {first, first + size};
}

}  // namespace anticrack::results::hdf5
