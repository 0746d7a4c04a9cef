// An export format of one's own: a table of all positions, as CSV.
#include "network/network_builder.h"
#include "output/exporters/exporter.h"
#include "output/run_recorder.h"
#include "simulation/simulator.h"

#include <iostream>
#include <sstream>

/// One file, a line for each vertex and frame.
class TableExporter final : public sprung::Exporter {
 public:
  explicit TableExporter(sprung::ExportedRun run) : run_(std::move(run)) { table_ << "frame,body,vertex,x,y,z\n"; }

  std::vector<std::string> patterns() const override { return {"positions.csv"}; }
  bool writes_each_frame() const override { return false; }
  std::vector<sprung::ExportedFile> frame(const sprung::ExportedFrame& frame) override {
    for (const sprung::RecordedBody& body : run_.model.bodies) {
      const sprung::Points x = vertices_of(body, frame.state);
      for (int i = 0; i < x.cols(); ++i) {
        table_ << frame.number << ',' << body.name << ',' << i << ',' << x(0, i) << ',' << x(1, i) << ',' << x(2, i) << '\n';
      }
    }
    return {};
  }
  std::vector<sprung::ExportedFile> end(int /*frames*/) override { return {{"positions.csv", table_.str()}}; }

 private:
  sprung::ExportedRun run_;
  std::ostringstream table_;
};

int main() {
  sprung::SpringMaterials springs;
  springs.structural = sprung::SpringMaterial{.value = 500.0, .damping = 0.5};  // [N/m], [N s/m]
  sprung::BodyShape rope = sprung::make_rope({.points = {{0, 0, 0}, {1, 0, 0}}, .particles = 11}, springs);
  sprung::set_total_mass(rope, 0.1);
  sprung::NetworkBuilder builder;
  builder.add_body("rope", rope);
  builder.pin(0);
  sprung::Simulator simulator(builder.build(), {.step = 0.001});

  const sprung::RunRecorder recorder(simulator, {}, {});
  TableExporter table({.model = recorder.model(), .frame_rate = 25.0, .frames = 26});
  for (int frame = 1; frame <= 26; ++frame) {
    while (frame > 1 && simulator.time() < (frame - 1) / 25.0 - 1e-9) simulator.step();
    (void)table.frame({.number = frame, .state = sprung::RunRecorder::frame(simulator)});
  }
  for (const sprung::ExportedFile& file : table.end(26)) std::cout << file.bytes;
  return 0;
}
