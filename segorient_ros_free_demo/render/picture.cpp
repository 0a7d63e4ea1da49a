// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace segorient::program {

Picture beside(const std::vector<Picture>& pictures) {
  std::size_t width = 0;
  for (const Picture& p : pictures) width += p.width;
  Picture out(width, pictures.empty() ? 0 : pictures.front().height);
  std::size_t left = 0;
  for (const Picture& p : pictures) {
    for (std::size_t y = 0; y < out.height; ++y) {
      std::copy_n(p.rgb.data() + 3 * y * p.width, 3 * p.width,
                  out.rgb.data() + 3 * (y * out.width + left));
    }
    left += p.width;
  }
  return out;
}

Picture halved(const Picture& picture) {
  Picture out(picture.width / 2, picture.height / 2);
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < 3 * out.width; ++x) {
      const std::size_t column = 6 * (x / 3) + x % 3;
      const std::uint8_t* from = picture.rgb.data() + 6 * y * picture.width + column;
      const std::uint8_t* below = from + 3 * picture.width;
      const unsigned sum = 2U + from[0] + from[3] + below[0] + below[3];
      out.rgb[3 * y * out.width + x] = static_cast<std::uint8_t>(sum / 4U);
    }
  }
  return out;
}

void writePng(const Picture& picture, OutputFile& file) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(picture.width), static_cast<int>(picture.height), 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* to = static_cast<std::uint8_t*>(image->GetScalarPointer());
  const std::size_t row = 3 * picture.width;
  for (std::size_t y = 0; y < picture.height; ++y) {  // VTK's rows begin at the bottom
    std::copy_n(picture.rgb.data() + (picture.height - 1 - y) * row, row, to + y * row);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  const vtkUnsignedCharArray* png = writer->GetResult();
  if (png == nullptr) throw std::bad_alloc();
  file.write(const_cast<vtkUnsignedCharArray*>(png)->GetPointer(0),
             static_cast<std::size_t>(png->GetNumberOfValues()));
}

}  // namespace segorient::program
