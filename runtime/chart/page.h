// The HTML page with all charts, maps and rows of a run: a single text that needs no network and runs no scripts.
//
// Charts are inline SVG. Maps are links to files next to the page. The page follows the reader's light or dark scheme
// and scrolls wide charts and tables on narrow screens.
// Tested by: tests/runtime/chart/chart_page_test.cpp
#pragma once

#include <string>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

struct PageChart {
  std::string svg;      // from plot_svg()
  std::string reading;  // explains how to read the chart
};

struct PageMap {
  std::string file;  // relative to the page
  std::string title;
  std::string reading;
};

struct PageScene {
  std::string name;  // RayMeasurement::scene of its rows
  std::vector<PageChart> charts;
  std::vector<PageMap> maps;
};

struct Page {
  std::vector<PageScene> scenes;
  std::vector<RayMeasurement> rays;  // of all scenes; each scene's table shows its own
  std::vector<std::string> files;    // for download, relative to the page
  Provenance provenance;
};

std::string page_html(const Page& page);

// Captions that explain how to read charts A and B.
extern const char* const kReadChartATime;
extern const char* const kReadChartAEvaluations;
extern const char* const kReadChartB;
extern const char* const kReadChartLight;

}  // namespace fathom::runtime
