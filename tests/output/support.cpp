#include "output/support.hpp"

#include <hdf5.h>
#include <sys/mount.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace output_test {

namespace fs = std::filesystem;

SmallDisk::SmallDisk(std::size_t bytes)
    : mounted(::mount("tmpfs", scratch.path.c_str(), "tmpfs", 0, ("size=" + std::to_string(bytes)).c_str()) == 0) {}
SmallDisk::~SmallDisk() {
  if (mounted) ::umount2(scratch.path.c_str(), MNT_DETACH);
}

void spill(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

Story::Story(std::size_t beads, std::size_t walls) : work_(walls), position_(3 * beads), velocity_(3 * beads), spin_(3 * beads) {
  for (std::size_t k = 0; k < beads; ++k) {
    id_.push_back(static_cast<std::uint32_t>(k));
    material_.push_back(k % 2 == 0 ? 0 : 1);
    radius_.push_back(0.005);
    mass_.push_back(0.0013);
  }
}

millscope::output::BeadTable Story::table() const {
  std::vector<std::string> walls;
  for (std::size_t k = 0; k < work_.size(); ++k) walls.push_back("wall" + std::to_string(k));
  return {id_,
          radius_,
          mass_,
          material_,
          {"glass", "steel"},
          walls,
          {"glass~glass.normal"},
          {"glass~glass", "glass~liner"},
          {1e-6, 1e-5, 1e-4, 1e-3}};
}

millscope::output::FrameView Story::frame(int k) {
  for (std::size_t at = 0; at < position_.size(); ++at) {
    position_[at] = k + 0.25 * static_cast<double>(at);
    velocity_[at] = -position_[at];
    spin_[at] = 2 * position_[at];
  }
  for (double& work : work_) work = 0.1 * k;
  millscope::output::FrameView frame;
  frame.time = 0.005 * k;
  frame.wall_angle = 0.3 * k;
  frame.angular_velocity = -6.1;
  frame.wall_work = work_;
  frame.dissipation = {position_.data(), 1};
  impacts_.assign(6, static_cast<std::uint64_t>(k));
  impacts_[5] = 7 * static_cast<std::uint64_t>(k);
  frame.impacts = impacts_;
  frame.position = position_;
  frame.velocity = velocity_;
  frame.spin = spin_;
  return frame;
}

std::vector<double> read_all(const fs::path& path, const std::string& dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error("HDF5 does not open " + path.string());
  const hid_t set = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  const herr_t status = values.empty() ? 0 : H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  if (status < 0) throw std::runtime_error("HDF5 does not read " + dataset + " of " + path.string());
  return values;
}

}  // namespace output_test
