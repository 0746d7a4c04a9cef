// A folder of src/ includes only folders on lower floors, a sub-folder only those that it may, and a third-party library stays in
// the folders that own it.
#include "project/source_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace sprung::project {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::map<std::string, int> kFloors = {{"base", 0},     {"geometry", 1},   {"network", 2}, {"collision", 2},
                                            {"dynamics", 3}, {"simulation", 4}, {"output", 5},  {"scene", 6},
                                            {"sweep", 7},    {"viewer", 7},     {"app", 8},     {"python", 8}};

/// What the sub-folders of a folder may include of it, the lowest first. Files that stand in the folder itself are on top, and may
/// include all of it, unless the folder has an entry here: "" names them among what others may include.
const std::map<std::string, std::set<std::string>> kSubFloors = {
    {"base", {}},
    {"base/files", {""}},
    {"base/machine", {""}},

    {"geometry/queries", {}},
    {"geometry/motion", {}},
    {"geometry/mesh", {"queries"}},
    {"geometry/import", {"mesh"}},
    {"geometry/obj_source", {"mesh", "import"}},
    {"geometry/tetrahedra", {"import"}},

    {"network/model", {}},
    {"network/bodies", {"model"}},

    {"collision/core", {}},
    {"collision/surface", {"core"}},
    {"collision/mesh_bvh", {"core"}},
    {"collision/safe_regions", {"core", "mesh_bvh"}},
    {"collision/shapes", {"safe_regions", "mesh_bvh"}},
    {"collision/primitives", {"shapes", "safe_regions"}},
    {"collision/obstacles", {"core", "surface", "shapes", "primitives"}},
    {"collision/obstacle_regions", {"core", "surface", "safe_regions", "shapes", "obstacles"}},
    {"collision/element_bvh", {"core", "surface"}},
    {"collision/pairs", {"core", "surface", "safe_regions", "element_bvh"}},
    {"collision/impact_zones", {"core", "surface", "safe_regions", "pairs", "obstacle_regions"}},
    {"collision/truncation", {"core", "surface", "obstacles", "obstacle_regions", "impact_zones"}},

    {"dynamics/numerics", {}},
    {"dynamics/air", {}},
    {"dynamics/state", {}},
    {"dynamics/forces", {"numerics", "air", "state"}},
    {"dynamics/integrators", {"numerics", "state", "forces"}},
    {"dynamics/constraints", {"state"}},
    {"dynamics/attachments", {"numerics", "state", "forces", "constraints"}},
    {"dynamics/contact", {"state", "forces", "integrators"}},
    {"dynamics/tethers", {"numerics", "state"}},
    {"dynamics/stretch_newton", {"numerics", "state", "constraints", "tethers"}},
    {"dynamics/stretch_limit", {"numerics", "state", "constraints", "tethers", "stretch_newton"}},

    {"simulation/settings", {}},
    {"simulation/monitoring", {"settings"}},
    {"simulation/sleep", {}},
    {"simulation/start", {"settings"}},
    {"simulation/model", {"settings"}},
    {"simulation/step", {"model", "settings"}},

    {"output/record", {}},
    {"output/exporters", {"record"}},

    {"app/text", {}},

    {"python/simulator", {}},

    {"viewer", {}},
    {"viewer/protocol", {}},
    {"viewer/server", {"protocol"}},
    {"viewer/replay", {"protocol"}},
    {"viewer/live", {"", "protocol", "server", "replay"}},

    {"scene/format", {}},
    {"scene/json", {}},
    {"scene/materials", {}},
    {"scene/reading", {"format", "json", "materials"}},
    {"scene/step_choice", {"format"}},
    {"scene/building", {"format", "json", "materials", "step_choice"}},
};

struct Library {
  std::string prefix;             ///< of its includes
  std::set<std::string> folders;  ///< that may include it
  bool in_one_source = false;     ///< a single .cpp may include it
};

const std::vector<Library> kLibraries = {
    {"oneapi/tbb/", {"base"}},
    {"assimp/", {"geometry"}, true},
    {"tiny_obj_loader.h", {"geometry"}, true},
    {"fcl/", {"collision"}},
    {"nlohmann/", {"geometry", "scene", "output", "sweep", "viewer"}},
    {"boost/", {"viewer"}},
    {"zlib.h", {"viewer"}, true},
    {"zip.h", {"output"}, true},
    {"tiny_gltf.h", {"output"}, true},
    {"CLI/", {"app"}},
    {"fmt/", {"app"}},
    {"pybind11/", {"python"}},
    {"sanitizer/", {"base"}},
    {"xmmintrin.h", {"base"}},
    {"poll.h", {"sweep"}},
    {"fcntl.h", {"app", "base", "output", "sweep"}},
    {"unistd.h", {"app", "base", "output", "sweep"}},
    {"sys/", {"app", "base", "output", "sweep"}},
};

/// Standard headers have neither a dot nor a slash.
bool is_standard(const Include& include) { return include.path.find_first_of("./") == std::string::npos; }

/// The folder of a path from src/: "collision/core" of "collision/core/contact.h".
std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

void check_sub_floor(const SourceFile& file, const Include& include, std::vector<std::string>& problems) {
  const std::string from = folder_of(file.path);
  const std::string to = folder_of(include.path);
  if (from == to) return;
  const std::string to_sub_folder = to == file.folder ? "" : to.substr(file.folder.size() + 1);
  const auto allowed = kSubFloors.find(from);
  if (allowed != kSubFloors.end() && !allowed->second.contains(to_sub_folder)) {
    problems.push_back(file.path + " includes \"" + include.path + "\", which its sub-folder may not");
  }
}

void check_own(const SourceFile& file, const Include& include, std::vector<std::string>& problems) {
  const std::string folder = include.path.substr(0, include.path.find('/'));
  if (folder == file.folder) return check_sub_floor(file, include, problems);
  const auto theirs = kFloors.find(folder);
  if (theirs == kFloors.end()) {
    problems.push_back(file.path + " includes \"" + include.path + "\", which starts with no folder of src/");
  } else if (theirs->second >= kFloors.at(file.folder)) {
    problems.push_back(file.path + " includes \"" + include.path + "\", which is not on a lower floor");
  }
}

void check_library(const SourceFile& file, const Include& include, std::vector<std::string>& problems) {
  if (is_standard(include) || include.path.starts_with("Eigen/")) return;
  const auto library = std::find_if(kLibraries.begin(), kLibraries.end(),
                                    [&](const Library& candidate) { return include.path.starts_with(candidate.prefix); });
  if (library == kLibraries.end()) {
    problems.push_back(file.path + " includes <" + include.path + ">, which no folder owns");
  } else if (!library->folders.contains(file.folder)) {
    problems.push_back(file.path + " includes <" + include.path + ">, which belongs to another folder");
  } else if (library->in_one_source && file.is_header()) {
    problems.push_back(file.path + " includes <" + include.path + "> in a header");
  }
}

std::vector<std::string> problems_of(const SourceFile& file) {
  if (!kFloors.contains(file.folder)) return {file.path + " is in a folder that has no floor"};
  std::vector<std::string> problems;
  const std::string folder = folder_of(file.path);
  if (folder != file.folder && !kSubFloors.contains(folder))
    problems.push_back(file.path + " is in a sub-folder that has no floor");
  for (const Include& include : file.includes) (include.quoted ? check_own : check_library)(file, include, problems);
  return problems;
}

std::vector<SourceFile> sprung_sources() { return read_sources(std::filesystem::path(SPRUNG_SOURCE_DIR) / "src"); }

TEST(Floors, EveryFileIncludesOnlyLowerFloorsAndItsOwnLibraries) {
  const std::vector<SourceFile> files = sprung_sources();
  ASSERT_GT(files.size(), 50u) << "the sources were not found";
  for (const SourceFile& file : files) EXPECT_THAT(problems_of(file), IsEmpty());
}

TEST(Floors, AssimpAndTinyobjloaderEachLiveInOneSource) {
  for (const Library& library : kLibraries) {
    if (!library.in_one_source) continue;
    std::set<std::string> users;
    for (const SourceFile& file : sprung_sources()) {
      for (const Include& include : file.includes) {
        if (include.path.starts_with(library.prefix)) users.insert(file.path);
      }
    }
    EXPECT_EQ(users.size(), 1u) << library.prefix << " is included by " << ::testing::PrintToString(users);
  }
}

TEST(Floors, EveryOwnIncludeStartsAtTheSourceFolder) {
  for (const SourceFile& file : sprung_sources()) {
    for (const Include& include : file.includes) {
      if (!include.quoted) continue;
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(SPRUNG_SOURCE_DIR) / "src" / include.path))
          << file.path << " includes \"" << include.path << "\"";
    }
  }
}

TEST(Floors, LowerFloorsAndOwnedLibrariesAreAllowed) {
  const SourceFile file = parse_source("collision/shapes/obstacle.cpp",
                                       "#include \"collision/shapes/obstacle.h\"\n#include \"base/types.h\"\n"
                                       "#include <vector>\n#include <Eigen/Core>\n#include <fcl/geometry/shape/box.h>\n");
  EXPECT_EQ(file.includes.size(), 5u);
  EXPECT_THAT(problems_of(file), IsEmpty());
}

TEST(Floors, AHigherFloorIsReported) {
  EXPECT_THAT(problems_of(parse_source("network/a.h", "#pragma once\n  #  include \"simulation/simulator.h\"\n")),
              ElementsAre(HasSubstr("not on a lower floor")));
}

TEST(Floors, TheSameFloorIsReported) {
  EXPECT_THAT(problems_of(parse_source("network/a.cpp", "#include \"collision/obstacle.h\"\n")),
              ElementsAre(HasSubstr("not on a lower floor")));
}

TEST(Floors, AFolderWithoutFloorIsReported) {
  EXPECT_THAT(problems_of(parse_source("helpers/a.h", "")), ElementsAre(HasSubstr("no floor")));
  EXPECT_THAT(problems_of(parse_source("app/a.h", "#include \"a.h\"\n")), ElementsAre(HasSubstr("no folder")));
}

TEST(Floors, AHigherSubFloorIsReported) {
  EXPECT_THAT(problems_of(parse_source("collision/core/a.h", "#include \"collision/obstacles/obstacle_set.h\"\n")),
              ElementsAre(HasSubstr("its sub-folder may not")));
  EXPECT_THAT(problems_of(parse_source("simulation/step/a.h", "#include \"simulation/simulator.h\"\n")),
              ElementsAre(HasSubstr("its sub-folder may not")));
  EXPECT_THAT(problems_of(parse_source("base/a.h", "#include \"base/machine/kernel.h\"\n")),
              ElementsAre(HasSubstr("its sub-folder may not")));
}

TEST(Floors, ALowerSubFloorAndTheFolderItselfAreAllowed) {
  EXPECT_THAT(problems_of(parse_source("collision/obstacles/a.h", "#include \"collision/core/contact.h\"\n")), IsEmpty());
  EXPECT_THAT(problems_of(parse_source("simulation/a.h", "#include \"simulation/step/step_report.h\"\n")), IsEmpty());
}

TEST(Floors, ASubFolderWithoutFloorIsReported) {
  EXPECT_THAT(problems_of(parse_source("collision/helpers/a.h", "")), ElementsAre(HasSubstr("sub-folder that has no floor")));
}

/// Two that may include each other would make a circle.
TEST(Floors, NoSubFoldersMayIncludeEachOther) {
  for (const auto& [folder, allowed] : kSubFloors) {
    std::set<std::string> reached;
    std::vector<std::string> open(allowed.begin(), allowed.end());
    const std::string parent = folder.substr(0, folder.find('/'));
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      if (!reached.insert(next).second) continue;
      const std::set<std::string>& more = kSubFloors.at(next.empty() ? parent : parent + "/" + next);
      open.insert(open.end(), more.begin(), more.end());
    }
    EXPECT_FALSE(reached.contains(folder == parent ? "" : folder.substr(parent.size() + 1))) << folder;
  }
}

TEST(Floors, ALibraryOutsideItsFolderIsReported) {
  EXPECT_THAT(problems_of(parse_source("dynamics/forces/a.cpp", "#include <fcl/math/bv/AABB.h>\n")),
              ElementsAre(HasSubstr("belongs to another folder")));
  EXPECT_THAT(problems_of(parse_source("geometry/import/a.h", "#include <assimp/scene.h>\n")),
              ElementsAre(HasSubstr("in a header")));
  EXPECT_THAT(problems_of(parse_source("app/a.cpp", "#include <opencv2/core.hpp>\n")), ElementsAre(HasSubstr("no folder owns")));
}

}  // namespace
}  // namespace sprung::project
