// CAD files to test with, made by OpenCASCADE itself. All lengths mm.
#pragma once

#include <numbers>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/IGESCAFControl_Writer.hxx>
#include <opencascade/Interface_Static.hxx>
#include <opencascade/Message.hxx>
#include <opencascade/Message_Messenger.hxx>
#include <opencascade/Message_Printer.hxx>
#include <opencascade/Quantity_Color.hxx>
#include <opencascade/STEPCAFControl_Writer.hxx>
#include <opencascade/TDataStd_Name.hxx>
#include <opencascade/TDocStd_Document.hxx>
#include <opencascade/XCAFApp_Application.hxx>
#include <opencascade/XCAFDoc_ColorTool.hxx>
#include <opencascade/XCAFDoc_DocumentTool.hxx>
#include <opencascade/XCAFDoc_ShapeTool.hxx>
#include <opencascade/gp_Ax2.hxx>
#include <opencascade/gp_Trsf.hxx>
#include <opencascade/gp_Vec.hxx>
#include <string>

namespace geometry_test {

/// A document that parts are added to and that is written in the end.
class CadFile {
 public:
  CadFile() {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));  // it tells of every file
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", data_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(data_->Main());
    colours_ = XCAFDoc_DocumentTool::ColorTool(data_->Main());
  }

  TDF_Label add(const TopoDS_Shape& shape, const char* name) {
    const TDF_Label label = shapes_->AddShape(shape, false);
    TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  }
  TDF_Label assembly(const char* name) {
    const TDF_Label label = shapes_->NewShape();
    TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  }
  /// Turned about z by `angle` (rad), then shifted along x.
  TDF_Label use(const TDF_Label& assembly, const TDF_Label& part, double angle, double x = 0) {
    gp_Trsf turn, shift;
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), angle);
    shift.SetTranslation(gp_Vec(x, 0, 0));
    return shapes_->AddComponent(assembly, part, TopLoc_Location(shift * turn));
  }
  void hide(const TDF_Label& part) { colours_->SetVisibility(part, false); }
  void colour(const TDF_Label& part, double red, double green, double blue) {
    colours_->SetColor(part, Quantity_Color(red, green, blue, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  }
  void colour(const TDF_Label& part, const TopoDS_Shape& face, double red, double green, double blue) {
    colours_->SetColor(shapes_->AddSubShape(part, face), Quantity_Color(red, green, blue, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  }

  /// `unit`: MM, M, INCH; `schema`: 3, 4, 5 for AP203, AP214, AP242.
  void write_step(const std::string& path, const char* unit = "MM", int schema = 4) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer().ChangeWriter().Model(true);  // only then there is a unit to set
    Interface_Static::SetCVal("write.step.unit", unit);
    Interface_Static::SetIVal("write.step.schema", schema);
    STEPCAFControl_Writer writer;
    writer.Transfer(data_);
    writer.Write(path.c_str());
  }
  /// Each part into a file of its own, beside one that refers to them.
  void write_several(const std::string& path) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.Transfer(data_, STEPControl_AsIs, "part_");
    writer.Write(path.c_str());
  }
  void write_iges(const std::string& path) {
    shapes_->UpdateAssemblies();
    IGESCAFControl_Writer writer;
    writer.Transfer(data_);
    writer.Write(path.c_str());
  }

 private:
  Handle(TDocStd_Document) data_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
};

/// A tube round z from z = 0.
inline TopoDS_Shape tube(double inner, double outer, double length) {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(outer, length).Shape(), BRepPrimAPI_MakeCylinder(inner, length).Shape()).Shape();
}

/// A bar along z on the inside of a shell of that radius, at angle 0.
inline TopoDS_Shape bar(double radius, double height, double width, double length) {
  return BRepPrimAPI_MakeBox(gp_Pnt(radius - height, -width / 2, 0), gp_Pnt(radius + 1, width / 2, length)).Shape();
}

/// A liner of a shell (150 mm) and `lifters` bars (10 x 8 mm), 60 mm long.
inline void add_liner(CadFile& file, int lifters) {
  const TDF_Label mill = file.assembly("mill"), shell = file.add(tube(150, 155, 60), "shell"),
                  lifter = file.add(bar(150, 10, 8, 60), "lifter");
  file.use(mill, shell, 0);
  for (int i = 0; i < lifters; ++i) file.use(mill, lifter, 2 * std::numbers::pi * i / lifters);
}

}  // namespace geometry_test
