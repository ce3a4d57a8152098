// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/requests.hpp"

#include "digest/digest.hpp"

namespace anticrack::testing {
namespace {

void add_point(v1::Point& to, double x, double y) {
  to.set_x(x);
  to.set_y(y);
}

}  // namespace

v1::CreateUploadsRequest::Header upload_header(const std::string& content, v1::Upload::Kind kind) {
  v1::CreateUploadsRequest::Header header;
  header.set_size(content.size());
  header.set_sha256(digest::Sha256().add(content).finish());
  header.set_kind(kind);
  return header;
}

v1::CreateMeshRequest paper_mesh(double size) {
  v1::CreateMeshRequest request;
  v1::Geometry& geometry = *request.mutable_geometry();
  add_point(*geometry.add_boundary(), -1, -1);
  add_point(*geometry.add_boundary(), 1, -1);
  add_point(*geometry.add_boundary(), 1, 1);
  add_point(*geometry.add_boundary(), -1, 1);
  v1::Polyline& interface = *geometry.add_interfaces()->mutable_polyline();
  add_point(*interface.add_points(), -1, 0);
  add_point(*interface.add_points(), 1, 0);
  v1::Inclusion& inclusion = *geometry.add_inclusions();
  inclusion.set_name("fibre");
  add_point(*inclusion.mutable_part()->mutable_from(), -0.5, 0);
  add_point(*inclusion.mutable_part()->mutable_to(), 0.5, 0);
  request.mutable_options()->set_preset(v1::MESH_PRESET_UNIFORM);
  request.mutable_options()->set_size(size);
  request.set_title("section 8");
  return request;
}

v1::CreateJobRequest opening_job(const std::string& mesh) {
  v1::CreateJobRequest request;
  request.mutable_spec()->set_mesh(mesh);
  v1::LoadCase& load = *request.mutable_spec()->add_load_cases();
  load.set_name("opening");
  load.mutable_force()->set_expression("y > 0 ? 1 : -1");
  return request;
}

std::string packed(const std::vector<double>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

v1::CreateJobRequest sweep_job(const std::string& mesh, const std::vector<double>& coefficients) {
  v1::CreateJobRequest request = opening_job(mesh);
  v1::JobSpec& job = *request.mutable_spec();
  v1::LoadCase& slope = *job.add_load_cases();
  slope.set_name("slope");
  slope.mutable_force()->set_expression("x");
  v1::LoadCase& push = *job.add_load_cases();
  push.set_name("push");
  (*push.mutable_inclusion_forces())["fibre"] = 1;
  job.mutable_sweep()->mutable_coefficients()->set_packed(packed(coefficients));
  return request;
}

v1::CreateJobRequest endless_job(const std::string& mesh) {
  v1::CreateJobRequest request = opening_job(mesh);
  v1::Uzawa& uzawa = *request.mutable_spec()->mutable_solver()->mutable_uzawa();
  uzawa.set_theta(1e-9);  // so small that the iteration goes nowhere for hours
  uzawa.set_epsilon(1e-300);
  uzawa.set_max_iterations(2'000'000'000);
  return request;
}

std::string small_msh() {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
         "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
         "$Elements\n2\n1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n";
}

}  // namespace anticrack::testing
