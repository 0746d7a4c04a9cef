#include "viewer/protocol/text_messages.h"

#include "viewer/protocol/base64.h"

#include <nlohmann/json.hpp>

namespace sprung {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string hello_text(const std::string& mode, const std::string& title, const std::vector<ExampleScene>& examples) {
  Json list = Json::array();
  for (const ExampleScene& example : examples) {
    list.push_back({{"name", example.name}, {"sentence", example.sentence}, {"picture", !example.picture.empty()}});
  }
  return text_of({{"type", "hello"}, {"version", SPRUNG_VERSION}, {"mode", mode}, {"title", title}, {"examples", list}});
}

std::string picture_text(const std::string& example, const Bytes& png) {
  return text_of({{"type", "picture"}, {"example", example}, {"png", base64(png)}});
}

std::string state_text(const PlayState& state) {
  return text_of({{"type", "state"}, {"playing", state.playing}, {"every", state.every}, {"speed", state.speed}});
}

std::string problems_text(std::optional<std::uint32_t> run, const std::string& key, const std::vector<Problem>& problems) {
  Json list = Json::array();
  for (const Problem& problem : problems) {
    list.push_back({{"file", problem.file},
                    {"key", problem.key},
                    {"value", problem.value},
                    {"rule", problem.rule},
                    {"remedy", problem.remedy},
                    {"text", to_string(problem)}});
  }
  return text_of({{"type", "problems"}, {"run", run ? Json(*run) : Json()}, {"key", key}, {"problems", list}});
}

std::string obj_message(const std::string& name, const std::string& text) {
  return text_of({{"type", "obj"}, {"name", name}, {"text", text}});
}

std::string tension_text(std::uint32_t run, Index spring, double tension, bool with_limit) {
  return text_of({{"type", "tension"}, {"run", run}, {"spring", spring}, {"tension", tension}, {"limit", with_limit}});
}

std::string saved_text(const std::string& name, const std::string& text) {
  return text_of({{"type", "saved"}, {"name", name}, {"text", text}});
}

std::string notice_text(const std::string& text) { return text_of({{"type", "notice"}, {"text", text}}); }

std::string error_text(const std::string& text) { return text_of({{"type", "error"}, {"text", text}}); }

std::string removed_text(std::uint32_t run) { return text_of({{"type", "removed"}, {"run", run}}); }

}  // namespace sprung
