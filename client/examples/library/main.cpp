// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solves a case with the C++ library: how far an upward load of 1 lifts a delaminated rigid fibre.
//   solve [HOST:PORT]        default: 127.0.0.1:7433
#include <google/protobuf/text_format.h>
#include <anticrack/client/jobs.hpp>
#include <anticrack/client/meshes.hpp>

#include <iostream>
#include <stdexcept>

// The text form of anticrack/v1/mesh.proto's CreateMeshRequest; code can set its fields as well.
constexpr const char* membrane = R"(geometry {
  boundary { x: -1 y: -1 } boundary { x: 1 y: -1 } boundary { x: 1 y: 1 } boundary { x: -1 y: 1 }
  interfaces { name: "sigma" polyline { points { x: -1 } points { x: 1 } } }
  inclusions { name: "fibre" part { from { x: -0.5 } to { x: 0.5 } } delaminated: true }
})";

int main(int argc, char** argv) try {
  using namespace anticrack;
  client::ConnectionOptions options;
  if (argc > 1) options.address = argv[1];
  client::Connection connection(options);
  v1::CreateMeshRequest request;
  google::protobuf::TextFormat::ParseFromString(membrane, &request);
  v1::JobSpec spec;
  spec.set_mesh(client::create_mesh(connection, request).name());
  v1::LoadCase& load = *spec.add_load_cases();
  load.set_name("upward");
  load.mutable_force()->set_expression("1");
  v1::Job job = client::create_job(connection, spec, client::make_uuid());
  job = client::watch_job(connection, job.name(), 0, [](const v1::WatchJobResponse& event) {
    const std::string& phase = event.phase().detail();
    if (!phase.empty()) std::cout << phase << std::endl;
  });
  for (const v1::LoadCaseAnswer& answer : job.status().answers()) {
    for (const v1::InclusionAnswer& inclusion : answer.inclusions())
      std::cout << answer.name() << ": A = " << inclusion.displacement() << '\n';
    // The answer is then the last iterate and not a solution; the reason names the cure.
    if (answer.status() == v1::LoadCaseAnswer::STATUS_NOT_CONVERGED)
      std::cerr << answer.name() << " did not converge: " << answer.reason() << '\n';
  }
  if (job.status().has_error()) throw std::runtime_error(job.status().error().message());
  return job.status().state() == v1::JobStatus::STATE_SUCCEEDED ? 0 : 3;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
