#include "output/exporters/exporter.h"

#include "output/exporters/gltf_exporter.h"
#include "output/exporters/npz_exporter.h"
#include "output/exporters/obj_exporter.h"
#include "output/exporters/ply_exporter.h"
#include "output/exporters/point_cache_exporter.h"
#include "output/exporters/usd_exporter.h"
#include "output/exporters/vtk_exporter.h"

#include <functional>
#include <utility>

namespace sprung {
namespace {

using Make = std::function<std::unique_ptr<Exporter>(ExportedRun)>;

template <class Format, class... Arguments>
Make maker(Arguments... arguments) {
  return [=](ExportedRun run) { return std::make_unique<Format>(std::move(run), arguments...); };
}

/// The one place where a format is listed.
const std::vector<std::pair<std::string, Make>>& makers() {
  static const std::vector<std::pair<std::string, Make>> kAll{{"obj", maker<ObjExporter>()},
                                                              {"ply", maker<PlyExporter>()},
                                                              {"pc2", maker<PointCacheExporter>(PointCacheExporter::Format::pc2)},
                                                              {"mdd", maker<PointCacheExporter>(PointCacheExporter::Format::mdd)},
                                                              {"vtk", maker<VtkExporter>()},
                                                              {"gltf", maker<GltfExporter>()},
                                                              {"npz", maker<NpzExporter>(NpzExporter::Precision::float32)},
                                                              {"npz64", maker<NpzExporter>(NpzExporter::Precision::float64)},
                                                              {"usda", maker<UsdExporter>()}};
  return kAll;
}

}  // namespace

const std::vector<std::string>& exporter_formats() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> all;
    for (const auto& [name, make] : makers()) all.push_back(name);
    return all;
  }();
  return kNames;
}

std::unique_ptr<Exporter> make_exporter(const std::string& format, ExportedRun run) {
  for (const auto& [name, make] : makers()) {
    if (name == format) return make(std::move(run));
  }
  return nullptr;
}

}  // namespace sprung
