// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <vtkFreeTypeTools.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <array>

#include "render/vtk/parts.h"

namespace segorient::program::vtk {
namespace {

constexpr int kDotsPerInch = 72;  // a point is a pixel

}  // namespace

TextLine textLine(const std::string& text, int size) {
  vtkNew<vtkTextProperty> font;
  font->SetFontFamilyToArial();
  font->SetFontSize(size);
  font->SetColor(0.0, 0.0, 0.0);
  vtkFreeTypeTools* tools = vtkFreeTypeTools::GetInstance();
  tools->ScaleToPowerTwoOff();
  vtkNew<vtkImageData> image;
  std::array<int, 2> dimensions{};
  TextLine line;
  if (!tools->RenderString(font, text, kDotsPerInch, image, dimensions.data())) return line;
  std::array<int, 6> extent{};
  image->GetExtent(extent.data());
  line.width = extent[1] - extent[0] + 1;
  line.height = extent[3] - extent[2] + 1;
  for (int y = extent[3]; y >= extent[2]; --y) {  // VTK's rows begin at the bottom
    for (int x = extent[0]; x <= extent[1]; ++x) {
      const auto* rgba = static_cast<const std::uint8_t*>(image->GetScalarPointer(x, y, 0));
      line.ink.push_back(rgba[3]);
    }
  }
  return line;
}

}  // namespace segorient::program::vtk
