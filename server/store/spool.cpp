// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/spool.hpp"

#include <algorithm>
#include <utility>

#include "digest/digest.hpp"
#include "stop/stop.hpp"

namespace anticrack::store {

namespace {

constexpr std::size_t most_memory = std::size_t{1} << 20U;
constexpr const char* spool_name = "the file of a running job's result";

}  // namespace

Spool::Spool(std::function<base::Descriptor()> open,
             std::function<DiskUsage::Reservation(std::uint64_t)> reserve)
    : _open(std::move(open)), _reserve(std::move(reserve)) {}

Spool::Run Spool::append(std::span<const std::byte> bytes) {
  const std::lock_guard lock(_mutex);
  const Run run{_written + _memory.size(), bytes.size()};
  _memory.insert(_memory.end(), bytes.begin(), bytes.end());
  if (_memory.size() > most_memory) write_out();
  _held = _memory.size();
  return run;
}

void Spool::write_out() {
  try {
    DiskUsage::Reservation reservation = _reserve(_memory.size());
    if (!_file) _file.emplace(_open());
    write_at(*_file, spool_name, _written, _memory);
    _reserved.push_back(std::move(reservation));
    _written += _memory.size();
    _memory.clear();
  } catch (const errors::Error&) {
    // The next piece tries again, and overwrites what the failed write left in the file.
  }
}

void Spool::read(std::uint64_t place, std::span<std::byte> bytes) const {
  const std::lock_guard lock(_mutex);
  const std::uint64_t in_file =
      place < _written ? std::min<std::uint64_t>(_written - place, bytes.size()) : 0;
  if (in_file > 0) read_at(*_file, spool_name, place, bytes.first(in_file));
  const std::span<const std::byte> rest(_memory);
  if (in_file < bytes.size()) {
    std::ranges::copy(rest.subspan(place + in_file - _written, bytes.size() - in_file),
                      bytes.begin() + static_cast<std::ptrdiff_t>(in_file));
  }
}

class SpooledBlock::Source final : public records::BlockSource {
 public:
  explicit Source(std::shared_ptr<const Spool> spool) : _spool(std::move(spool)) {}

  void add_array(records::ArrayLayout layout) { _arrays.push_back(std::move(layout)); }
  void add_run(const Spool::Run& run) {
    if (run.bytes > 0) _runs.push_back({_size, run});
    _size += run.bytes;
  }
  /// Aligns the size for the next array and returns its offset.
  std::uint64_t align() { return _size = records::aligned(_size); }
  void hash() {
    _sha256 = digest::sha256_of(_size, [this](std::uint64_t offset, std::span<std::byte> bytes) {
      stop::look("hashing a result");
      read(offset, bytes);
    });
  }

  const std::vector<records::ArrayLayout>& arrays() const noexcept override { return _arrays; }
  std::uint64_t size() const noexcept override { return _size; }
  const std::string& sha256() const noexcept override { return _sha256; }
  void read(std::uint64_t offset, std::span<std::byte> bytes) const override {
    std::ranges::fill(bytes, std::byte{0});
    const std::uint64_t end = offset + bytes.size();
    auto part = std::ranges::upper_bound(_runs, offset, {}, &Part::offset);
    if (part != _runs.begin()) --part;
    for (; part != _runs.end() && part->offset < end; ++part) {
      const std::uint64_t from = std::max(offset, part->offset);
      const std::uint64_t to = std::min(end, part->offset + part->run.bytes);
      if (from < to) {
        _spool->read(part->run.place + (from - part->offset),
                     bytes.subspan(from - offset, to - from));
      }
    }
  }

 private:
  struct Part {
    std::uint64_t offset;  ///< in the block
    Spool::Run run;
  };

  std::shared_ptr<const Spool> _spool;
  std::vector<records::ArrayLayout> _arrays;
  std::vector<Part> _runs;  ///< ascending
  std::uint64_t _size = 0;
  std::string _sha256;
};

SpooledBlock::SpooledBlock(std::shared_ptr<const Spool> spool)
    : _source(std::make_shared<Source>(std::move(spool))) {}

void SpooledBlock::add(std::string name, records::ArrayType type, std::vector<std::uint64_t> shape,
                       std::span<const Spool::Run> runs) {
  _source->add_array({std::move(name), type, std::move(shape), _source->align()});
  for (const Spool::Run& run : runs) _source->add_run(run);
}

void SpooledBlock::add(std::span<const records::ArrayLayout> arrays, const Spool::Run& run) {
  const std::uint64_t offset = _source->align();
  for (records::ArrayLayout array : arrays) {
    array.offset += offset;
    _source->add_array(std::move(array));
  }
  _source->add_run(run);
}

std::shared_ptr<const records::BlockSource> SpooledBlock::finish() {
  _source->hash();
  return std::exchange(_source, nullptr);
}

}  // namespace anticrack::store
