// The page that shows all charts, maps and rows of a run: one HTML text that needs no network and runs no scripts.
//
// Charts stand in the page as SVG, maps are linked by the names of their files beside it. It follows the reader's
// light or dark scheme and scrolls wide charts and tables on narrow screens.
// Tested by: tests/runtime/chart/chart_page_test.cpp
#pragma once

#include <string>
#include <vector>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

struct PageChart {
  std::string svg;      // as plot_svg() gives it
  std::string reading;  // a sentence: how to read it
};

struct PageMap {
  std::string file;  // relative to the page
  std::string title;
  std::string reading;
};

struct PageScene {
  std::string name;  // that of its rows
  std::vector<PageChart> charts;
  std::vector<PageMap> maps;
};

struct Page {
  std::vector<PageScene> scenes;
  std::vector<RayMeasurement> rays;  // the table of a scene has its own
  std::vector<std::string> files;    // to download, relative to the page
  Provenance provenance;
};

std::string page_html(const Page& page);

// How charts A and B are read: the sentences under them.
extern const char* const kReadChartATime;
extern const char* const kReadChartAEvaluations;
extern const char* const kReadChartB;
extern const char* const kReadChartLight;

}  // namespace fathom::runtime
