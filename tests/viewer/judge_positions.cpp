// Judges frames of a scene that the page showed: judge_positions SCENE FRAMES. FRAMES holds 32-bit floats x, y, z of all particles,
// frame by frame. Obstacles are where they are at time 0. Prints what meets an obstacle and ends with 1 if anything does.
#include "scenarios/judge.h"
#include "scene/load_scene.h"

#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

namespace sprung::testing {
namespace {

/// Throws std::runtime_error if the file does not hold whole frames of `particles`.
std::vector<Points> read_frames(const std::string& file, Index particles) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t frame_size = static_cast<std::size_t>(particles) * 3 * sizeof(float);
  if (bytes.empty() || bytes.size() % frame_size != 0) throw std::runtime_error(file + " does not hold whole frames");
  std::vector<Points> frames;
  for (std::size_t begin = 0; begin < bytes.size(); begin += frame_size) {
    Eigen::Matrix3Xf positions(3, particles);
    bytes.copy(reinterpret_cast<char*>(positions.data()), frame_size, begin);
    frames.emplace_back(positions.cast<double>());
  }
  return frames;
}

int judge(const std::string& scene, const std::string& file) {
  const LoadedScene loaded = load_scene({.file = scene, .overrides = {}, .mesh_paths = {SPRUNG_TEST_MESHES}});
  const SpringNetwork& network = loaded.simulator.network();
  const auto elements = judged_elements(network);
  const std::vector<Points> frames = read_frames(file, network.particle_count());
  Index wrong = 0;
  for (const Obstacle& obstacle : loaded.simulator.obstacles()) {
    const auto of_obstacle = judge_of(obstacle.geometry);
    const RigidTransform to_obstacle = obstacle.motion.pose(obstacle.rest_pose, 0.0).inverse();
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const Points positions = to_obstacle * frames[k];
      const Index inside = of_obstacle->count_inside(positions);
      const Index crossings = of_obstacle->count_crossings(elements, positions);
      if (inside + crossings > 0) {
        std::cout << "frame " << k << ", " << obstacle.name << ": " << inside << " particles inside, " << crossings
                  << " crossings\n";
      }
      wrong += inside + crossings;
    }
  }
  std::cout << frames.size() << " frames judged\n";
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace sprung::testing

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: judge_positions SCENE FRAMES\n";
    return 2;
  }
  return sprung::testing::judge(argv[1], argv[2]);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
