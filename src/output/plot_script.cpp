#include "output/plot_script.h"

#include "base/format.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace sprung {
namespace {

// Colours that people with any colour vision tell apart (Okabe and Ito 2008).
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

/// A curve: sums of columns, times a factor.
struct Curve {
  std::string title;
  std::vector<std::string> columns;
  double factor = 1.0;
};

struct Panel {
  std::string title;
  std::vector<Curve> of_one;      ///< of a single run
  std::vector<Curve> of_several;  ///< of each of several runs
};

std::vector<Panel> panels() {
  const Curve total{"total", {"kinetic_energy", "elastic_energy", "gravity_energy", "contact_energy"}};
  const Curve stretch{"largest", {"max_stretch"}, 100.0};
  const Curve contacts{"particles in contact", {"contacts"}};
  const Curve time{"a frame", {"frame_ms"}};
  return {{"energy [J]",
           {{"kinetic", {"kinetic_energy"}}, {"elastic", {"elastic_energy"}}, {"gravity", {"gravity_energy"}}, total},
           {total}},
          {"stretch of springs [%]", {stretch, {"beyond the limit", {"stretch_excess"}, 100.0}}, {stretch}},
          {"contacts", {contacts, {"stopped at surfaces", {"truncated"}}}, {contacts}},
          {"computing time [ms]", {time}, {time}}};
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    result += letter == '\n' ? ' ' : letter;
  }
  return result + '"';
}

/// A block of data named $dN: time and value of each frame; none if the run has no such columns.
std::optional<std::string> block(const RecordedDiagnostics& table, const Curve& curve, int number) {
  const auto position = [&](const std::string& name) { return std::ranges::find(table.columns, name) - table.columns.begin(); };
  const auto count = static_cast<std::ptrdiff_t>(table.columns.size());
  const std::ptrdiff_t time = position("time");
  std::vector<std::ptrdiff_t> columns;
  for (const std::string& name : curve.columns) {
    if (position(name) < count) columns.push_back(position(name));
  }
  if (time == count || columns.empty()) return std::nullopt;
  std::string text = "$d" + std::to_string(number) + " << EOD\n";
  for (const std::vector<double>& row : table.rows) {
    double sum = 0.0;
    for (const std::ptrdiff_t column : columns) sum += row[static_cast<std::size_t>(column)];
    if (!std::isfinite(sum)) continue;
    append_number(text, row[static_cast<std::size_t>(time)]);
    text += ' ';
    append_number(text, curve.factor * sum);
    text += '\n';
  }
  return text + "EOD\n";
}

}  // namespace

std::string plot_script(const std::vector<PlottedRun>& runs, const std::string& file, PlotFormat format) {
  const bool is_one = runs.size() == 1;
  std::string data;
  std::string plots;
  int number = 0;
  for (const Panel& panel : panels()) {
    std::string curves;
    std::size_t colour = 0;
    for (const PlottedRun& run : runs) {
      for (const Curve& curve : is_one ? panel.of_one : panel.of_several) {
        const auto values = block(run.diagnostics, curve, number);
        if (!values) continue;
        data += *values;
        curves += (curves.empty() ? "plot $d" : ", \\\n     $d") + std::to_string(number++);
        curves.append(" using 1:2 with lines linewidth 2 linecolor rgb \"").append(kColours[colour++ % kColours.size()]);
        curves.append("\" title ").append(quoted(is_one ? curve.title : run.title));
      }
    }
    plots.append("set title ").append(quoted(panel.title)).append("\n");
    plots += curves.empty() ? "plot NaN notitle\n" : curves + "\n";
  }
  const std::string terminal =
      format == PlotFormat::png ? "pngcairo size 1200,900 font \"Sans,11\"" : "svg size 1200,900 font \"Sans,13\"";
  return data + "set terminal " + terminal + " noenhanced\nset output " + quoted(file) +
         "\nset grid linetype 1 linewidth 1 linecolor rgb \"#cccccc\"\nset border 3\nset tics nomirror\nset xlabel \"time [s]\"\n"
         "set key outside above horizontal\n"
         "set multiplot layout 2,2" +
         (is_one ? " title " + quoted(runs.front().title) : "") + "\n" + plots + "unset multiplot\n";
}

}  // namespace sprung
