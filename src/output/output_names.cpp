#include "output/output_names.h"

#include "base/error.h"
#include "base/files/file_pattern.h"
#include "simulation/simulator.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace sprung {
namespace {

const std::string kObstacleFolder = "obstacles";

void check_names(const char* key, const std::vector<std::string>& names, std::vector<Problem>& problems) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (!is_folder_name(name)) {
      problems.push_back(
          {"", key, '"' + name + '"', "must consist of letters, digits, _ and -, because it names a folder", "rename it"});
    } else if (!seen.insert(name).second) {
      problems.push_back({"", key, '"' + name + '"', "must be unique, because it names a folder", "rename one of them"});
    }
  }
}

}  // namespace

void check_output_names(const Simulator& simulator) {
  std::vector<std::string> bodies;
  std::vector<std::string> obstacles;
  for (const Body& body : simulator.network().bodies) bodies.push_back(body.name);
  for (const Obstacle& obstacle : simulator.obstacles()) obstacles.push_back(obstacle.name);
  std::vector<Problem> problems;
  check_names("body", bodies, problems);
  check_names("obstacle", obstacles, problems);
  if (std::find(bodies.begin(), bodies.end(), kObstacleFolder) != bodies.end()) {
    problems.push_back({"", "body", '"' + kObstacleFolder + '"', "is reserved for the folder of the obstacles", "rename it"});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace sprung
