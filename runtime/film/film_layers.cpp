#include "runtime/film/film_layers.h"

#include "runtime/film/film_channels.h"

namespace fathom::runtime {

LayerValues layer_of(const Film& film, Layer layer) {
  switch (layer) {
    case Layer::Beauty:
      return {layer, film.area(), [&film](int x, int y) { return glm::vec3(film.means(x, y).radiance); }};
    case Layer::Albedo:
      return {layer, film.area(), [&film](int x, int y) { return glm::vec3(film.means(x, y).albedo); }};
    case Layer::Depth:
      return {layer, film.area(), [&film](int x, int y) { return glm::vec3(film.means(x, y).depth); }};
    case Layer::Noisy:
      return {layer, film.area(), [&film](int x, int y) { return glm::vec3(film.means(x, y).noisy); }};
    case Layer::Normal:
      break;
  }
  return {layer, film.area(), [&film](int x, int y) { return glm::vec3(normal_of_hits(film.means(x, y))); }};
}

}  // namespace fathom::runtime
