// SPDX-License-Identifier: GPL-3.0-or-later
//
// fuzz_seeds EXAMPLES FOLDER: writes what the binary formats' fuzzers begin with, as today's code
// writes them, to FOLDER/TARGET/NAME. EXAMPLES: the folder of the client's example cases.
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "anticrack/v1/upload.pb.h"
#include "api/requests.hpp"
#include "digest/digest.hpp"
#include "fuzz/input.hpp"
#include "fuzz/small_result.hpp"
#include "mesh/codec.hpp"
#include "mesher/grading.hpp"
#include "mesher/import.hpp"
#include "mesher/msh_writer.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "store/record_codec.hpp"
#include "support/block_maker.hpp"
#include "support/case_file.hpp"

namespace {

using namespace anticrack;
using fuzz::as_piece;
namespace fs = std::filesystem;

fs::path root;

void save(const std::string& target, const std::string& name, const std::string& bytes) {
  fs::create_directories(root / target);
  std::ofstream(root / target / name, std::ios::binary) << bytes;
}

/// With the byte before it by which a target chooses.
std::string chosen(int selector, const std::string& bytes) {
  return std::string(1, static_cast<char>(selector)) + bytes;
}

std::string text_of(const mesh::Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void save_mesh_request(const std::string& name, const v1::CreateMeshRequest& request) {
  save("requests", name + "-mesh", chosen(0, request.SerializeAsString()));
  records::MeshRecord record;
  record.id = "0123456789abcdef";
  record.owner = "somebody";
  record.definition = api::to_definition(request);
  record.error = errors::Error(errors::Reason::mesh_invalid, "wrong").at("upload").with("a", "b");
  record.subdomains = {{"minus", 10, 20, 2, 1, true, 45, 0.1, 0.2}};
  record.interfaces = {{"sigma", 2, 11, {{mesh::Kind::delaminated, 0, 0.5, 1.5, 5}}}};
  record.inclusions = {"fibre"};
  record.warnings = {"one"};
  record.tips = {{{0.5, 0}, "sigma", 1e-9}};
  save("records", name + "-mesh", chosen(0, store::encode(record)));
  if (const auto* source = std::get_if<records::GeometrySource>(&record.definition)) {
    const mesh::MesherRequest wanted =
        mesh::GenerateRequest{mesh::plan(source->geometry, source->options, 1'000'000), 1'000'000};
    save("mesher_codec", name + "-generate", chosen(0, text_of(mesh::encode(wanted))));
  }
}

void save_job_request(const std::string& name, const v1::JobSpec& spec) {
  using namespace std::chrono_literals;
  v1::CreateJobRequest request;
  *request.mutable_spec() = spec;
  request.mutable_spec()->set_mesh("meshes/0123456789abcdef");
  request.set_request_id("123e4567-e89b-42d3-a456-426614174000");
  save("requests", name + "-job", chosen(1, request.SerializeAsString()));
  records::JobRecord record;
  record.id = "fedcba9876543210";
  record.request_id = request.request_id();
  record.spec = api::to_spec(request.spec(), {1'000'000, 24h, 24h});
  record.cases.resize(record.spec.loads.size());
  record.timeline = {{records::Clock::now(), records::JobState::running, "meshing"}};
  save("records", name + "-job", chosen(1, store::encode(record)));
}

void save_cases(const fs::path& examples) {
  save(
      "case_file", "json",
      R"({"geometry": {"boundary": [[0, 0], [1, 0], [1, 1]], "interface": [[0, 0], [1, 1]],)"
      R"( "crack": [{"name": "c", "from": [0.2, 0.2], "to": [0.5, 0.5]}]},)"
      R"( "load": [{"name": "a", "f": "x*y", "point_forces": [{"at": [0.5, 0.1], "value": 1}]}]})");
  for (const auto& entry : fs::directory_iterator(examples)) {
    if (entry.path().extension() != ".toml") continue;
    const casefile::Case example = anticrack::testing::read_case_file(entry.path());
    const std::string name = entry.path().stem();
    save("case_file", name, example.text);
    save("case_file", name + "-set", "#set mesh.size=0.1\n#set title=another\n" + example.text);
    v1::CreateMeshRequest mesh = example.mesh;
    if (example.mesh_file) mesh.set_upload("uploads/" + std::string(64, 'a'));
    save_mesh_request(name, mesh);
    save_job_request(name, example.spec);
  }
}

v1::JobSpec sweep_job(v1::Sweep sweep, int load_cases) {
  v1::JobSpec spec;
  for (int i = 0; i < load_cases; ++i) {
    v1::LoadCase& load = *spec.add_load_cases();
    load.set_name("basis " + std::to_string(i));
    load.mutable_force()->set_constant(1.5);
  }
  *spec.mutable_sweep() = std::move(sweep);
  return spec;
}

void save_sweeps() {
  const double values[] = {1, -0.5, 0, 2};
  v1::Sweep packed;
  packed.mutable_coefficients()->set_packed(values, sizeof values);
  packed.add_traces(0);
  packed.add_traces(1);
  save_job_request("sweep-packed", sweep_job(packed, 2));
  v1::Sweep uploaded;
  uploaded.mutable_coefficients()->set_upload("uploads/" + std::string(64, 'a'));
  save_job_request("sweep-uploaded", sweep_job(uploaded, 1));
  v1::Sweep nodal;
  nodal.mutable_nodal_forces()->set_packed(values, sizeof values);
  save_job_request("sweep-nodal", sweep_job(nodal, 0));
}

template <class Request>
void save_name(int selector, const std::string& name) {
  Request request;
  request.set_name(name);
  save("requests", "name-" + std::to_string(selector),
       chosen(selector, request.SerializeAsString()));
}

template <class Request>
void save_page(int selector) {
  Request request;
  request.set_page_size(10);
  request.set_page_token("0123456789abcdef");
  save("requests", "page-" + std::to_string(selector),
       chosen(selector, request.SerializeAsString()));
}

void save_small_requests() {
  const std::string mesh = "meshes/0123456789abcdef";
  const std::string job = "jobs/0123456789abcdef";
  save_name<v1::GetMeshRequest>(2, mesh);
  save_name<v1::ReadMeshRequest>(3, mesh);
  save_name<v1::DeleteMeshRequest>(4, mesh);
  save_name<v1::WarmMeshRequest>(5, mesh);
  save_name<v1::EvictMeshRequest>(6, mesh);
  save_name<v1::GetJobRequest>(7, job);
  save_name<v1::CancelJobRequest>(8, job);
  save_name<v1::DeleteJobRequest>(9, job);
  save_name<v1::WatchJobRequest>(10, job);
  save_name<v1::ReadResultRequest>(11, job);
  save_page<v1::ListMeshesRequest>(12);
  save_page<v1::ListJobsRequest>(13);
}

void save_meshes() {
  int number = 0;
  for (const auto format : testing::all_formats) {
    for (const char* middle : {"delaminated:stiffener", "crack", "inclusion:i", ""}) {
      const std::string bytes = testing::write_msh(testing::square_sample(middle), format);
      save("msh_file", std::to_string(number++), bytes);
    }
  }
  const std::string bytes =
      testing::write_msh(testing::square_sample(), testing::MshFormat::ascii41);
  mesh::Mesh mesh = mesher::import_msh(bytes, mesh::MeshOptions{}, 1'000);
  save("mesher_codec", "mesh", chosen(2, text_of(mesh::encode(mesh))));
  save("mesher_codec", "import",
       chosen(0, text_of(mesh::encode(mesh::MesherRequest(mesh::ImportRequest{"", {}, 1'000})))));
  save("mesher_codec", "reply", chosen(1, text_of(mesh::encode(mesh::MesherReply(mesh)))));
  save("mesher_codec", "refusal",
       chosen(1, text_of(mesh::encode(mesh::MesherReply(
                     errors::Error(errors::Reason::mesh_invalid, "wrong").at("upload"))))));
}

std::string upload(v1::Upload::Kind content, const std::string& bytes) {
  v1::CreateUploadsRequest first;
  first.mutable_header()->set_size(bytes.size());
  first.mutable_header()->set_sha256(digest::Sha256().add(bytes).finish());
  first.mutable_header()->set_kind(content);
  std::string stream = as_piece(first.SerializeAsString());
  const std::size_t half = bytes.size() / 2;
  for (const std::string& part : {bytes.substr(0, half), bytes.substr(half)}) {
    v1::CreateUploadsRequest chunk;
    chunk.set_chunk(part);
    stream += as_piece(chunk.SerializeAsString());
  }
  return stream;
}

void save_uploads() {
  const double values[] = {1, 2.5, -3};
  const std::string array(reinterpret_cast<const char*>(values), sizeof values);
  const std::string msh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  for (const int selector : {0, 1}) {
    const std::string at = std::to_string(selector);
    save("upload", "array-" + at, chosen(selector, upload(v1::Upload::KIND_ARRAY, array)));
    save("upload", "msh-" + at, chosen(selector, upload(v1::Upload::KIND_MSH, msh)));
  }
}

/// A block as result_stream takes it: with the chunk as a message, or its data alone.
std::string stream(testing::BlockMaker block, bool data_alone) {
  block.layout.set_size(block.bytes.size());
  block.layout.set_sha256(digest::Sha256().add(block.bytes).finish());
  v1::BlockChunk chunk;
  chunk.set_data(block.bytes.data(), block.bytes.size());
  chunk.set_crc32c(digest::crc32c(block.bytes));
  return as_piece(block.layout.SerializeAsString()) +
         as_piece(data_alone ? chunk.data() : chunk.SerializeAsString());
}

void save_result() {
  const testing::ResultBlocks blocks(fuzz::small_result());
  for (const bool corrected : {false, true}) {
    save("result_stream", corrected ? "corrected" : "plain",
         chosen(corrected ? 1 : 0,
                stream(blocks.mesh, corrected) + stream(blocks.answer, corrected)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: fuzz_seeds EXAMPLES FOLDER\n";
    return 2;
  }
  try {
    root = argv[2];
    save_cases(argv[1]);
    save_sweeps();
    save_small_requests();
    save_meshes();
    save_uploads();
    save_result();
  } catch (const std::exception& error) {
    std::cerr << "fuzz_seeds: " << error.what() << '\n';
    return 1;
  }
}
