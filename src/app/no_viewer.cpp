// The commands of the viewer in a program that was built without it.
#include "app/commands.h"
#include "base/error.h"

namespace sprung {
namespace {

[[noreturn]] void fail_without_viewer() {
  throw InputError({"", "", "", "this program was built without the viewer",
                    "run ./examples/view.sh, which installs npm and Boost and builds it"});
}

}  // namespace

ExitCode view(const ViewOptions& /*options*/) { fail_without_viewer(); }

void export_html(const std::string& /*folder*/, const std::filesystem::path& /*file*/) { fail_without_viewer(); }

}  // namespace sprung
