// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that are no good result: every one is refused with a clear error, none crashes the reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <array>
#include <fstream>
#include <functional>
#include <iterator>

#include "results/file.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

void expect_refused(const std::string& path, const std::string& cause) {
  try {
    read(path);
    FAIL() << "accepted; expected: " << cause;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith(path + ": "), HasSubstr(cause), HasSubstr("; ")));
  }
}

void save(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string bytes_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// With a thousand probes, so that one of the lists is compressed.
std::string good_bytes(int n) {
  const TemporaryFolder folder;
  Result result = sample_result(n);
  for (int i = 0; i < 1000; ++i) result.loads[0].answer.add_probes()->set_x(i);
  write(folder / "a.h5", result);
  return bytes_in(folder / "a.h5");
}

TEST(MalformedFile, truncated_anywhere) {
  const TemporaryFolder folder;
  const std::string bytes = good_bytes(8);
  for (std::size_t part = 1; part < 20; ++part) {
    save(folder / "a.h5", bytes.substr(0, bytes.size() * part / 20));
    expect_refused(folder / "a.h5", "is truncated or damaged");
  }
  save(folder / "a.h5", bytes.substr(0, bytes.size() - 1));
  expect_refused(folder / "a.h5", "is truncated or damaged");
}

/// Where the values of a dataset lie in the file: in its first chunk, or in its own header.
std::size_t data_address(const std::string& bytes, const std::string& path, const char* dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t id = H5Dopen2(file, dataset, H5P_DEFAULT);
  const hid_t space = H5Dget_space(id), type = H5Dget_type(id);
  const hid_t creation = H5Dget_create_plist(id);
  std::size_t at = std::string::npos;
  if (H5Pget_layout(creation) == H5D_CHUNKED) {
    std::array<hsize_t, 2> offset{};
    unsigned mask = 0;
    haddr_t address = HADDR_UNDEF;
    hsize_t size = 0;
    H5Dget_chunk_info(id, space, 0, offset.data(), &mask, &address, &size);
    at = address;
  } else {
    const hid_t numbers = H5Tget_class(type) == H5T_COMPOUND ? H5Tget_member_type(type, 1) : type;
    const hid_t read = H5Tget_class(type) == H5T_COMPOUND ? H5Tcreate(H5T_COMPOUND, 8) : type;
    if (read != type) H5Tinsert(read, "A", 0, numbers);
    std::string values(
        H5Tget_size(read) * static_cast<hsize_t>(H5Sget_simple_extent_npoints(space)), '\0');
    H5Dread(id, read, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5O_info_t header;
    H5Oget_info2(id, &header, H5O_INFO_BASIC);
    at = bytes.find(values, header.addr);
    if (read != type) H5Tclose(read);
    if (numbers != type) H5Tclose(numbers);
  }
  H5Pclose(creation);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(id);
  H5Fclose(file);
  return at;
}

TEST(MalformedFile, a_flipped_bit_in_any_dataset_is_noticed) {
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler leaks;  // HDF5 1.10 loses 2 kB for each damaged header
#endif
  H5garbage_collect();  // what is lost is then allocated by this test
  for (const char* dataset :
       {"/mesh/nodes", "/loads/opening/traces/0/u_plus", "/loads/opening/inclusions",
        "/loads/opening/probes", "/loads/opening/fields/1/u"}) {
    const TemporaryFolder folder;
    std::string bytes = good_bytes(40);
    save(folder / "good.h5", bytes);
    const std::size_t at = data_address(bytes, folder / "good.h5", dataset);
    ASSERT_LT(at, bytes.size()) << dataset;
    bytes[at + 3] = static_cast<char>(bytes[at + 3] ^ 0x10);
    save(folder / "a.h5", bytes);
    expect_refused(folder / "a.h5", "is damaged");
  }
}

/// A change to a good file through HDF5, and what the reader must say of it.
struct Damage {
  std::string name;
  std::function<void(hid_t file)> inflict;
  std::string complaint;
};

void replace_text(hid_t file, const char* object, const char* attribute, const char* value) {
  const hid_t id = H5Oopen(file, object, H5P_DEFAULT);
  H5Adelete(id, attribute);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t made = H5Acreate2(id, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(made, type, &value);
  H5Aclose(made);
  H5Sclose(space);
  H5Tclose(type);
  H5Oclose(id);
}

void replace_int(hid_t file, const char* object, const char* attribute, int value) {
  const hid_t id = H5Oopen(file, object, H5P_DEFAULT);
  H5Adelete(id, attribute);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t made = H5Acreate2(id, attribute, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(made, H5T_NATIVE_INT, &value);
  H5Aclose(made);
  H5Sclose(space);
  H5Oclose(id);
}

/// A dataset that was never written: all zero, of any claimed size.
void replace_dataset(hid_t file, const char* path, hid_t type, std::vector<hsize_t> shape) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  if (!shape.empty()) {
    const std::vector<hsize_t> chunk(shape.size(), 1);
    H5Pset_chunk(properties, static_cast<int>(shape.size()), chunk.data());
  }
  H5Dclose(H5Dcreate2(file, path, type, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}

void move_outside(hid_t file, const char* path, hsize_t count, const char* other) {
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, other, 0, count * 8);
  H5Dclose(H5Dcreate2(file, path, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
}

/// A member of records: its name and HDF5's type of it.
using Member = std::pair<std::string, hid_t>;

std::vector<Member> members_in(hid_t type) {
  std::vector<Member> members;
  for (int i = 0; i < H5Tget_nmembers(type); ++i) {
    char* const name = H5Tget_member_name(type, static_cast<unsigned>(i));
    members.emplace_back(name, H5Tget_member_type(type, static_cast<unsigned>(i)));
    H5free_memory(name);
  }
  return members;
}

/// Members beside each other, with so many bytes between them.
hid_t compound_of(const std::vector<Member>& members, std::size_t gap) {
  std::size_t size = 0;
  for (const auto& [_, type] : members) size += H5Tget_size(type) + gap;
  const hid_t made = H5Tcreate(H5T_COMPOUND, size);
  std::size_t offset = 0;
  for (const auto& [name, type] : members) {
    H5Tinsert(made, name.c_str(), offset, type);
    offset += H5Tget_size(type) + gap;
  }
  return made;
}

/// The type of the tips, with its members changed.
hid_t tips_type(hid_t file, const std::function<void(std::vector<Member>&)>& change,
                std::size_t gap = 0) {
  const hid_t id = H5Dopen2(file, "/loads/opening/tips", H5P_DEFAULT), type = H5Dget_type(id);
  std::vector<Member> members = members_in(type);
  change(members);
  const hid_t made = compound_of(members, gap);
  for (const auto& [_, each] : members) H5Tclose(each);
  H5Tclose(type);
  H5Dclose(id);
  return made;
}

/// Replaces the tips by two records, all zero, whose members `change` has changed.
void replace_tips(hid_t file, const std::function<void(std::vector<Member>&)>& change,
                  std::vector<hsize_t> shape = {2}) {
  const hid_t type = tips_type(file, change);
  replace_dataset(file, "/loads/opening/tips", type, std::move(shape));
  H5Tclose(type);
}

void as_it_was(std::vector<Member>&) {}

/// Gives a member the type that make() makes.
std::function<void(hid_t)> tips_with(const std::string& name, const std::function<hid_t()>& make) {
  return [=](hid_t file) {
    replace_tips(file, [&](std::vector<Member>& members) {
      for (auto& [each, own] : members)
        if (each == name) {
          H5Tclose(own);
          own = make();
        }
    });
  };
}

hid_t text_of_eight() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 8);
  return type;
}

/// Writes the tips anew, as records of this type, in a format without checksums. Returns the
/// dataset.
hid_t rewrite_tips(hid_t file, hid_t type) {
  const char* path = "/loads/opening/tips";
  const hid_t old = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(old);
  std::vector<char> records(H5Tget_size(type));
  H5Dread(old, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, records.data());
  H5Ldelete(file, path, H5P_DEFAULT);
  const hid_t made = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, records.data());
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, records.data());
  H5Dclose(old);
  H5Sclose(space);
  return made;
}

TEST(NewerFile, may_have_more_members_in_another_order_with_gaps) {
  const TemporaryFolder folder;
  const Result result = sample_result(2);
  write(folder / "a.h5", result);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const auto change = [](std::vector<Member>& members) {
    std::swap(members[0], members[1]);
    members.insert(members.begin() + 2, {"z", H5Tcopy(H5T_IEEE_F64LE)});
  };
  const hid_t type = tips_type(file, change, 3);
  H5Dclose(rewrite_tips(file, type));
  H5Tclose(type);
  H5Fclose(file);
  EXPECT_EQ(read(folder / "a.h5").loads[0].answer.DebugString(),
            result.loads[0].answer.DebugString());
}

class Damaged : public ::testing::TestWithParam<Damage> {};

TEST_P(Damaged, is_refused) {
  const TemporaryFolder folder;
  // 81 nodes, 128 triangles, 9 interface nodes, 5 stages
  write(folder / "a.h5", with_stages(sample_result(4)));
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  GetParam().inflict(file);
  H5Fclose(file);
  expect_refused(folder / "a.h5", GetParam().complaint);
}

const std::array<Damage, 38> damages{{
    {"format_foreign", [](hid_t f) { replace_text(f, "/", "format", "netcdf"); },
     "has format \"netcdf\""},
    {"format_older", [](hid_t f) { replace_text(f, "/", "format", "anticrack-result/1"); },
     "this client reads \"anticrack-result/2\""},
    {"format_no_text", [](hid_t f) { replace_int(f, "/", "format", 1); },
     "attribute format is not one variable-length text"},
    {"attribute_missing", [](hid_t f) { H5Adelete(f, "server_version"); },
     "attribute server_version is missing"},
    {"attribute_of_another_type", [](hid_t f) { replace_int(f, "/mesh", "mesh_seconds", 1); },
     "attribute mesh_seconds is not one float64"},
    {"status_unknown", [](hid_t f) { replace_text(f, "/loads/opening", "status", "fine"); },
     "unknown status \"fine\""},
    {"index_out_of_range", [](hid_t f) { replace_int(f, "/loads/opening", "index", 2); },
     "index of another or none"},
    {"index_negative", [](hid_t f) { replace_int(f, "/loads/opening", "index", -1); },
     "index of another or none"},
    {"index_twice", [](hid_t f) { replace_int(f, "/loads/opening", "index", 1); },
     "index of another or none"},
    {"group_missing", [](hid_t f) { H5Ldelete(f, "/mesh", H5P_DEFAULT); }, "\"mesh\" is missing"},
    {"dataset_missing", [](hid_t f) { H5Ldelete(f, "/mesh/nodes", H5P_DEFAULT); },
     "\"nodes\" is missing"},
    {"group_for_a_dataset",
     [](hid_t f) {
       H5Ldelete(f, "/mesh/nodes", H5P_DEFAULT);
       H5Gclose(H5Gcreate2(f, "/mesh/nodes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
     },
     "\"nodes\" is a group, not a dataset"},
    {"dataset_for_a_group",
     [](hid_t f) { replace_dataset(f, "/loads/opening/fields", H5T_STD_I32LE, {3}); },
     "\"fields\" is not a group"},
    {"wrong_type",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F32LE, {81, 2});
     },
     "dataset nodes is not float64"},
    {"wrong_rank", [](hid_t f) { replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {162}); },
     "dataset nodes is not of shape (n,2)"},
    {"wrong_columns",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {54, 3});
     },
     "dataset nodes is not of shape (n,2)"},
    {"list_of_an_older_client",
     [](hid_t f) {
       H5Ldelete(f, "/loads/opening/tips", H5P_DEFAULT);
       H5Gclose(H5Gcreate2(f, "/loads/opening/tips", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
       H5Gclose(H5Gcreate2(f, "/loads/opening/tips/x", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
     },
     "\"tips\" is a group, not a dataset; it has x"},
    {"list_of_numbers",
     [](hid_t f) { replace_dataset(f, "/loads/opening/tips", H5T_IEEE_F64LE, {2}); },
     "dataset tips is not a compound of several, such as complex numbers or a table but float64"},
    {"list_without_a_member",
     [](hid_t f) { replace_tips(f, [](auto& members) { members.erase(members.begin() + 7); }); },
     "dataset tips has no member K_III"},
    {"member_of_half_the_size", tips_with("G", [] { return H5Tcopy(H5T_IEEE_F32LE); }),
     "member G of dataset tips is not float64 but float32"},
    {"member_in_another_byte_order", tips_with("G", [] { return H5Tcopy(H5T_IEEE_F64BE); }),
     "member G of dataset tips is not float64 but big-endian float64"},
    {"member_without_sign", tips_with("closed", [] { return H5Tcopy(H5T_STD_U32LE); }),
     "member closed of dataset tips is not int32 but uint32"},
    {"member_of_lists", tips_with("G", [] { return H5Tvlen_create(H5T_IEEE_F64LE); }),
     "member G of dataset tips is not float64 but lists of values"},
    {"member_of_references", tips_with("G", [] { return H5Tcopy(H5T_STD_REF_OBJ); }),
     "member G of dataset tips is not float64 but of another type"},
    {"number_for_a_text", tips_with("kind", [] { return H5Tcopy(H5T_IEEE_F64LE); }),
     "member kind of dataset tips is not variable-length text but float64"},
    {"text_of_a_fixed_length", tips_with("kind", text_of_eight),
     "member kind of dataset tips is not variable-length text but text of a fixed length"},
    {"text_that_is_no_kind",  // never written, so empty
     [](hid_t f) { replace_tips(f, as_it_was); }, "has the unknown kind \"\""},
    {"list_of_two_dimensions",
     [](hid_t f) {
       replace_tips(f, as_it_was, {2, 1});
     },
     "dataset tips is not of shape (n) but (2,1)"},
    {"list_without_dimension", [](hid_t f) { replace_tips(f, as_it_was, {}); },
     "dataset tips is not of shape (n) but ()"},
    {"list_longer_than_the_file_can_hold",
     [](hid_t f) { replace_tips(f, as_it_was, {hsize_t{1} << 40}); },
     "dataset tips claims 1099511627776 rows, more than the file can hold"},
    {"list_by_a_soft_link",
     [](hid_t f) {
       H5Ldelete(f, "/loads/opening/tips", H5P_DEFAULT);
       H5Lcreate_soft("/loads/partly closed/tips", f, "/loads/opening/tips", H5P_DEFAULT,
                      H5P_DEFAULT);
     },
     "\"tips\" is a link, not data"},
    {"stages_of_answers_alone",
     [](hid_t f) {
       H5Ldelete(f, "/loads/opening/stages", H5P_DEFAULT);
       H5Lcreate_hard(f, "/loads/opening/tips", f, "/loads/opening/stages", H5P_DEFAULT,
                      H5P_DEFAULT);
     },
     "dataset stages has no member mesh"},
    {"claims_more_than_the_file_holds",
     [](hid_t f) {
       replace_dataset(f, "/mesh/nodes", H5T_IEEE_F64LE, {hsize_t{1} << 40, 2});
     },
     "more than the file can hold"},
    {"of_a_client_that_knew_no_inclusions",
     [](hid_t f) { H5Ldelete(f, "/mesh/inclusions", H5P_DEFAULT); },
     "\"inclusions\" is missing, in a file of anticrack 0.1.0"},
    {"of_a_client_that_knew_one_method",
     [](hid_t f) { H5Adelete_by_name(f, "/loads/opening", "weakly_active", H5P_DEFAULT); },
     "attribute weakly_active is missing"},
    {"names_of_inclusions_of_another_type",
     [](hid_t f) { replace_dataset(f, "/mesh/inclusions", H5T_STD_I32LE, {1}); },
     "dataset inclusions is not variable-length text"},
    {"external_link",
     [](hid_t f) {
       H5Ldelete(f, "/mesh", H5P_DEFAULT);
       H5Lcreate_external("other.h5", "/mesh", f, "mesh", H5P_DEFAULT, H5P_DEFAULT);
     },
     "\"mesh\" is a link, not data"},
    {"external_data",
     [](hid_t f) { move_outside(f, "/loads/opening/traces/0/u_plus", 9, "/etc/passwd"); },
     "dataset u_plus lies in another file"},
}};

INSTANTIATE_TEST_SUITE_P(MalformedFile, Damaged, ::testing::ValuesIn(damages),
                         [](const auto& each) { return each.param.name; });

/// The tips in a format without checksums, changed in the file: a list that HDF5 did not write.
class ForgedTips : public ::testing::Test {
 protected:
  void SetUp() override {
    H5garbage_collect();  // what is lost is then allocated by this test
    write(_path, sample_result(4));
    const hid_t file = H5Fopen(_path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t type = tips_type(file, as_it_was), made = rewrite_tips(file, type);
    _data = H5Dget_offset(made);
    H5O_info_t header;
    H5Oget_info2(made, &header, H5O_INFO_BASIC);
    H5Dclose(made);
    H5Tclose(type);
    H5Fclose(file);
    _bytes = bytes_in(_path);
    _header = header.addr;
    read(_path);
  }

  /// Where in the header a member's offset is, of a byte, behind its name.
  std::size_t offset_of(const std::string& name) const {
    return _bytes.find(name + std::string(1, '\0'), _header) + name.size() + 1;
  }
  /// The length, address and number of the first record's first text, behind x and y.
  std::size_t text_at() const { return _data + 16; }
  void put(std::size_t at, const std::string& bytes) {
    _bytes.replace(at, bytes.size(), bytes);
    save(_path, _bytes);
  }

#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler _leaks;  // HDF5 1.10 loses the headers of what it cannot read
#endif
  const TemporaryFolder _folder;
  const std::string _path = _folder / "a.h5";
  std::string _bytes;
  std::size_t _data = 0, _header = 0;
};

TEST_F(ForgedTips, with_a_name_twice_are_refused) {
  put(offset_of("x") - 2, "y");
  expect_refused(_path, "dataset tips");
}

TEST_F(ForgedTips, that_lie_over_each_other_are_refused) {
  put(offset_of("K_III"), _bytes.substr(offset_of("G"), 1));
  expect_refused(_path, "dataset tips");
}

TEST_F(ForgedTips, that_lie_outside_their_record_are_refused) {
  put(offset_of("K_III"), "\xff");
  expect_refused(_path, "dataset tips");
}

/// Of 64 MiB, for which HDF5 clears memory before it looks.
TEST_F(ForgedTips, with_a_text_longer_than_the_file_are_refused) {
  put(text_at(), std::string("\0\0\0\4", 4));
  expect_refused(_path, "dataset tips is damaged");
}

TEST_F(ForgedTips, with_a_text_outside_the_file_are_refused) {
  put(text_at() + 4, "\xff\xff\xff\x7f");
  expect_refused(_path, "dataset tips is damaged");
}

}  // namespace
}  // namespace anticrack::results
