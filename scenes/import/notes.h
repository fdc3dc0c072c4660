#pragma once

#include <string>
#include <vector>

namespace penumbra::scenes {

/// What an import left out or approximated. Notes of one kind are told once, with the first element
/// and the number of the others, so that a large file cannot make a long list.
class Notes {
 public:
  /// `where` names the element ("meshes[3] 'wheel'"), `what` goes on from there (" is left out").
  void add(const std::string& where, const std::string& what);
  /// Appends them in the order of their first element.
  void write_to(std::vector<std::string>& list) const;

 private:
  struct Kind {
    std::string where;
    std::string what;
    std::size_t count;
  };
  std::vector<Kind> kinds;
};

}  // namespace penumbra::scenes
