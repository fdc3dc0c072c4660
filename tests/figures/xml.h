#pragma once

#include <expat.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::figures {

/// An element of a document, with the text right inside it.
struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;

  double number(const std::string& attribute) const { return std::stod(attributes.at(attribute)); }
};

struct Xml {
  std::vector<Element> elements;  ///< in document order
  std::string error;              ///< empty: well-formed

  std::vector<Element> named(std::string_view name) const {
    std::vector<Element> found;
    for (const Element& element : elements)
      if (element.name == name) found.push_back(element);
    return found;
  }

  std::vector<std::string> texts() const {
    std::vector<std::string> found;
    for (const Element& element : named("text")) found.push_back(element.text);
    return found;
  }
};

/// Expat's judgement of a document.
inline Xml parse_xml(const std::string& document) {
  struct State {
    Xml xml;
    std::vector<std::size_t> open;
  } state;
  XML_Parser parser = XML_ParserCreate("UTF-8");
  XML_SetUserData(parser, &state);
  XML_SetElementHandler(
      parser,
      [](void* data, const char* name, const char** attributes) {
        auto& here = *static_cast<State*>(data);
        Element element{name, {}, {}};
        for (; *attributes != nullptr; attributes += 2)
          element.attributes[attributes[0]] = attributes[1];
        here.open.push_back(here.xml.elements.size());
        here.xml.elements.push_back(std::move(element));
      },
      [](void* data, const char*) { static_cast<State*>(data)->open.pop_back(); });
  XML_SetCharacterDataHandler(parser, [](void* data, const char* text, int length) {
    auto& here = *static_cast<State*>(data);
    here.xml.elements[here.open.back()].text.append(text, static_cast<std::size_t>(length));
  });
  if (XML_Parse(parser, document.data(), static_cast<int>(document.size()), 1) == XML_STATUS_ERROR)
    state.xml.error = XML_ErrorString(XML_GetErrorCode(parser));
  XML_ParserFree(parser);
  return std::move(state.xml);
}

}  // namespace penumbra::figures
