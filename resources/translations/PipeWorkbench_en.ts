<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="en" sourcelanguage="en">
    <context>
        <name>App::Property</name>
        <message>
            <source>A fitting (tee) or a branch welded on (set-on)</source>
            <translation>A fitting (tee) or a branch welded on (set-on)</translation>
        </message>
        <message>
            <source>Added to the bolts' length between flange and insulation, so that bolts can be pulled</source>
            <translation>Added to the bolts' length between flange and insulation, so that bolts can be pulled</translation>
        </message>
        <message>
            <source>Bends of straight pieces (segmented) or round ones, as of foam shells (smooth)</source>
            <translation>Bends of straight pieces (segmented) or round ones, as of foam shells (smooth)</translation>
        </message>
        <message>
            <source>Bends that are too tight for the thickness: two pieces with a mitre, or refuse</source>
            <translation>Bends that are too tight for the thickness: two pieces with a mitre, or refuse</translation>
        </message>
        <message>
            <source>Between a flange's rim and the inside of its box</source>
            <translation>Between a flange's rim and the inside of its box</translation>
        </message>
        <message>
            <source>Between the run's direction and the branch</source>
            <translation>Between the run's direction and the branch</translation>
        </message>
        <message>
            <source>Boxes of two half shells over flanges, or bare flanges</source>
            <translation>Boxes of two half shells over flanges, or bare flanges</translation>
        </message>
        <message>
            <source>By what the first and the last piece are longer than the half</source>
            <translation>By what the first and the last piece are longer than the half</translation>
        </message>
        <message>
            <source>CO2 of a kWh of energy in kg, 0: not known</source>
            <translation>CO2 of a kWh of energy in kg, 0: not known</translation>
        </message>
        <message>
            <source>Change of direction</source>
            <translation>Change of direction</translation>
        </message>
        <message>
            <source>Class that FreeCAD's own BIM exporter gives it</source>
            <translation>Class that FreeCAD's own BIM exporter gives it</translation>
        </message>
        <message>
            <source>Coverings: straight ones, bends, boxes, ...</source>
            <translation>Coverings: straight ones, bends, boxes, ...</translation>
        </message>
        <message>
            <source>Diameter D of the plate</source>
            <translation>Diameter D of the plate</translation>
        </message>
        <message>
            <source>Diameter K of the bolt circle; 0 where it is not known</source>
            <translation>Diameter K of the bolt circle; 0 where it is not known</translation>
        </message>
        <message>
            <source>Diameter L of a bolt hole; 0 where it is not known</source>
            <translation>Diameter L of a bolt hole; 0 where it is not known</translation>
        </message>
        <message>
            <source>Diameter of the neck where it leaves the plate; 0 for the pipe's</source>
            <translation>Diameter of the neck where it leaves the plate; 0 for the pipe's</translation>
        </message>
        <message>
            <source>Diameter of the raised face; 0 where it is not known</source>
            <translation>Diameter of the raised face; 0 where it is not known</translation>
        </message>
        <message>
            <source>Diameter of the rivet holes</source>
            <translation>Diameter of the rivet holes</translation>
        </message>
        <message>
            <source>Digest of what the shape was made from</source>
            <translation>Digest of what the shape was made from</translation>
        </message>
        <message>
            <source>Digests of the shape's parts</source>
            <translation>Digests of the shape's parts</translation>
        </message>
        <message>
            <source>Distance of the rivet holes along seams, 0 for none</source>
            <translation>Distance of the rivet holes along seams, 0 for none</translation>
        </message>
        <message>
            <source>Draw the bolts, through a partner of the same thickness</source>
            <translation>Draw the bolts, through a partner of the same thickness</translation>
        </message>
        <message>
            <source>Files of the photographs, relative to the document</source>
            <translation>Files of the photographs, relative to the document</translation>
        </message>
        <message>
            <source>First and last piece of a bend: half as long as the others, equal, or longer than the half</source>
            <translation>First and last piece of a bend: half as long as the others, equal, or longer than the half</translation>
        </message>
        <message>
            <source>Flanges of the same dimensions, which images cannot tell apart</source>
            <translation>Flanges of the same dimensions, which images cannot tell apart</translation>
        </message>
        <message>
            <source>From the branch's axis to the end of the run</source>
            <translation>From the branch's axis to the end of the run</translation>
        </message>
        <message>
            <source>From the branch's axis to the start of the run</source>
            <translation>From the branch's axis to the start of the run</translation>
        </message>
        <message>
            <source>From the face to the weld end</source>
            <translation>From the face to the weld end</translation>
        </message>
        <message>
            <source>From the run's axis to the end of the branch</source>
            <translation>From the run's axis to the end of the branch</translation>
        </message>
        <message>
            <source>From the weld end to the top</source>
            <translation>From the weld end to the top</translation>
        </message>
        <message>
            <source>Heat delivered over energy bought</source>
            <translation>Heat delivered over energy bought</translation>
        </message>
        <message>
            <source>Heat loss in W with the insulation, bare components included</source>
            <translation>Heat loss in W with the insulation, bare components included</translation>
        </message>
        <message>
            <source>Heat loss in W without insulation; 0 where the medium's temperature is not known</source>
            <translation>Heat loss in W without insulation; 0 where the medium's temperature is not known</translation>
        </message>
        <message>
            <source>Height of the raised face</source>
            <translation>Height of the raised face</translation>
        </message>
        <message>
            <source>Hours of operation in a year</source>
            <translation>Hours of operation in a year</translation>
        </message>
        <message>
            <source>How far a box reaches over the pipe's jacket</source>
            <translation>How far a box reaches over the pipe's jacket</translation>
        </message>
        <message>
            <source>How well the standard's dimensions are sourced</source>
            <translation>How well the standard's dimensions are sourced</translation>
        </message>
        <message>
            <source>Identity in exchange files</source>
            <translation>Identity in exchange files</translation>
        </message>
        <message>
            <source>Index of the pick that made the component, -1 for none</source>
            <translation>Index of the pick that made the component, -1 for none</translation>
        </message>
        <message>
            <source>Keep the component where and as it is, whatever is adjusted, measured again or joined to it</source>
            <translation>Keep the component where and as it is, whatever is adjusted, measured again or joined to it</translation>
        </message>
        <message>
            <source>Keep the photographs inside the document, which makes its file larger</source>
            <translation>Keep the photographs inside the document, which makes its file larger</translation>
        </message>
        <message>
            <source>Layers around the second one, outwards, each like '40 mm mineral wool'</source>
            <translation>Layers around the second one, outwards, each like '40 mm mineral wool'</translation>
        </message>
        <message>
            <source>Length along the axis</source>
            <translation>Length along the axis</translation>
        </message>
        <message>
            <source>Length of the neck's straight part at the weld end</source>
            <translation>Length of the neck's straight part at the weld end</translation>
        </message>
        <message>
            <source>Level of accuracy (USIBD)</source>
            <translation>Level of accuracy (USIBD)</translation>
        </message>
        <message>
            <source>Mark the beads along the round edges</source>
            <translation>Mark the beads along the round edges</translation>
        </message>
        <message>
            <source>Name in exchange files</source>
            <translation>Name in exchange files</translation>
        </message>
        <message>
            <source>Name of the project in reports and exchange files</source>
            <translation>Name of the project in reports and exchange files</translation>
        </message>
        <message>
            <source>Names of the cameras</source>
            <translation>Names of the cameras</translation>
        </message>
        <message>
            <source>Nominal diameter of the standard</source>
            <translation>Nominal diameter of the standard</translation>
        </message>
        <message>
            <source>Number of bolts; 0 where it is not known</source>
            <translation>Number of bolts; 0 where it is not known</translation>
        </message>
        <message>
            <source>Numbers of the ends that are joined to the own ones</source>
            <translation>Numbers of the ends that are joined to the own ones</translation>
        </message>
        <message>
            <source>Of all layers, without the jacket</source>
            <translation>Of all layers, without the jacket</translation>
        </message>
        <message>
            <source>Of the narrow end across the axis, where it is eccentric</source>
            <translation>Of the narrow end across the axis, where it is eccentric</translation>
        </message>
        <message>
            <source>Outer surface of the jacket, without overlaps</source>
            <translation>Outer surface of the jacket, without overlaps</translation>
        </message>
        <message>
            <source>Outside diameter</source>
            <translation>Outside diameter</translation>
        </message>
        <message>
            <source>Outside diameter of the branch</source>
            <translation>Outside diameter of the branch</translation>
        </message>
        <message>
            <source>Outside diameter of the narrow end</source>
            <translation>Outside diameter of the narrow end</translation>
        </message>
        <message>
            <source>Pieces of a segmented bend, 0: by the rule</source>
            <translation>Pieces of a segmented bend, 0: by the rule</translation>
        </message>
        <message>
            <source>Pipes and fittings that are insulated</source>
            <translation>Pipes and fittings that are insulated</translation>
        </message>
        <message>
            <source>Pressure class as a number</source>
            <translation>Pressure class as a number</translation>
        </message>
        <message>
            <source>Pressure class of the standards</source>
            <translation>Pressure class of the standards</translation>
        </message>
        <message>
            <source>Price of a kWh of energy, 0: not known</source>
            <translation>Price of a kWh of energy, 0: not known</translation>
        </message>
        <message>
            <source>RMS distance to the image edges in pixels (Eq. 4)</source>
            <translation>RMS distance to the image edges in pixels (Eq. 4)</translation>
        </message>
        <message>
            <source>Radius of the bent axis</source>
            <translation>Radius of the bent axis</translation>
        </message>
        <message>
            <source>Sheet metal around the insulation</source>
            <translation>Sheet metal around the insulation</translation>
        </message>
        <message>
            <source>Speed of the wind, 0 indoors</source>
            <translation>Speed of the wind, 0 indoors</translation>
        </message>
        <message>
            <source>Standard deviation of the direction</source>
            <translation>Standard deviation of the direction</translation>
        </message>
        <message>
            <source>Standard deviation of the measured diameter</source>
            <translation>Standard deviation of the measured diameter</translation>
        </message>
        <message>
            <source>Standard deviation of the middle along x, y, z in mm</source>
            <translation>Standard deviation of the middle along x, y, z in mm</translation>
        </message>
        <message>
            <source>Standard deviation of unit weight of the adjustment, 0 for none</source>
            <translation>Standard deviation of unit weight of the adjustment, 0 for none</translation>
        </message>
        <message>
            <source>Standard of the dimensions</source>
            <translation>Standard of the dimensions</translation>
        </message>
        <message>
            <source>Standard size within 3 sigma of a free diameter</source>
            <translation>Standard size within 3 sigma of a free diameter</translation>
        </message>
        <message>
            <source>Starts and ends, in mm from the pipe's start, of what was bridged</source>
            <translation>Starts and ends, in mm from the pipe's start, of what was bridged</translation>
        </message>
        <message>
            <source>Station in whose level frame the components are</source>
            <translation>Station in whose level frame the components are</translation>
        </message>
        <message>
            <source>Station that measured the component</source>
            <translation>Station that measured the component</translation>
        </message>
        <message>
            <source>Stations that measured the components</source>
            <translation>Stations that measured the components</translation>
        </message>
        <message>
            <source>Take the next thickness that can be bought where it follows from a rule</source>
            <translation>Take the next thickness that can be bought where it follows from a rule</translation>
        </message>
        <message>
            <source>Temperature of the medium in °C, -273.15: not known</source>
            <translation>Temperature of the medium in °C, -273.15: not known</translation>
        </message>
        <message>
            <source>Temperature of the surroundings in °C</source>
            <translation>Temperature of the surroundings in °C</translation>
        </message>
        <message>
            <source>The component that was measured, and how it was modelled (JSON)</source>
            <translation>The component that was measured, and how it was modelled (JSON)</translation>
        </message>
        <message>
            <source>The ends do not lie on one axis</source>
            <translation>The ends do not lie on one axis</translation>
        </message>
        <message>
            <source>The georeference as exchange files have it (JSON)</source>
            <translation>The georeference as exchange files have it (JSON)</translation>
        </message>
        <message>
            <source>The images do not support the pipe well</source>
            <translation>The images do not support the pipe well</translation>
        </message>
        <message>
            <source>The pipeline without its components (JSON); of its joints those hold that are linked</source>
            <translation>The pipeline without its components (JSON); of its joints those hold that are linked</translation>
        </message>
        <message>
            <source>The plant's coordinate system; empty where it is not known</source>
            <translation>The plant's coordinate system; empty where it is not known</translation>
        </message>
        <message>
            <source>These flanges as exchange files have them (JSON)</source>
            <translation>These flanges as exchange files have them (JSON)</translation>
        </message>
        <message>
            <source>Thickness C of the plate, raised face included</source>
            <translation>Thickness C of the plate, raised face included</translation>
        </message>
        <message>
            <source>Thickness of the inner layer where the rule is 'fixed'</source>
            <translation>Thickness of the inner layer where the rule is 'fixed'</translation>
        </message>
        <message>
            <source>Thickness of the second layer, 0 for none</source>
            <translation>Thickness of the second layer, 0 for none</translation>
        </message>
        <message>
            <source>Thickness of the sheet metal, 0: by the finished diameter after DIN 4140</source>
            <translation>Thickness of the sheet metal, 0: by the finished diameter after DIN 4140</translation>
        </message>
        <message>
            <source>Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)</source>
            <translation>Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)</translation>
        </message>
        <message>
            <source>Type of the standard; choosing one sets the bend radius</source>
            <translation>Type of the standard; choosing one sets the bend radius</translation>
        </message>
        <message>
            <source>Up to this distance two flange faces are taken for a valve's</source>
            <translation>Up to this distance two flange faces are taken for a valve's</translation>
        </message>
        <message>
            <source>Version of this object's properties</source>
            <translation>Version of this object's properties</translation>
        </message>
        <message>
            <source>Wall thickness; 0 where it is not known</source>
            <translation>Wall thickness; 0 where it is not known</translation>
        </message>
        <message>
            <source>What else is to be known</source>
            <translation>What else is to be known</translation>
        </message>
        <message>
            <source>What is added along the length seams</source>
            <translation>What is added along the length seams</translation>
        </message>
        <message>
            <source>What is added between the pieces of a bend</source>
            <translation>What is added between the pieces of a bend</translation>
        </message>
        <message>
            <source>What is added where a jacket goes over the next one</source>
            <translation>What is added where a jacket goes over the next one</translation>
        </message>
        <message>
            <source>What is closer to the finished surface is listed among the clashes</source>
            <translation>What is closer to the finished surface is listed among the clashes</translation>
        </message>
        <message>
            <source>What is closer to the insulation than the minimum distance</source>
            <translation>What is closer to the insulation than the minimum distance</translation>
        </message>
        <message>
            <source>What is joined to a component follows when the component is changed</source>
            <translation>What is joined to a component follows when the component is changed</translation>
        </message>
        <message>
            <source>What station.json holds</source>
            <translation>What station.json holds</translation>
        </message>
        <message>
            <source>What the colours of the components say</source>
            <translation>What the colours of the components say</translation>
        </message>
        <message>
            <source>What the inner layer is made of</source>
            <translation>What the inner layer is made of</translation>
        </message>
        <message>
            <source>What the length seams of neighbours are turned against each other</source>
            <translation>What the length seams of neighbours are turned against each other</translation>
        </message>
        <message>
            <source>What the properties do not say, as a specification file has it (JSON)</source>
            <translation>What the properties do not say, as a specification file has it (JSON)</translation>
        </message>
        <message>
            <source>What the rule 'heat loss' allows in W/m, and the rule 'surface temperature' in °C</source>
            <translation>What the rule 'heat loss' allows in W/m, and the rule 'surface temperature' in °C</translation>
        </message>
        <message>
            <source>What the second layer is made of</source>
            <translation>What the second layer is made of</translation>
        </message>
        <message>
            <source>What the sheet shrinks by for each bead</source>
            <translation>What the sheet shrinks by for each bead</translation>
        </message>
        <message>
            <source>What the thickness of the inner layer follows from</source>
            <translation>What the thickness of the inner layer follows from</translation>
        </message>
        <message>
            <source>Where station.json and the photographs were found last</source>
            <translation>Where station.json and the photographs were found last</translation>
        </message>
        <message>
            <source>Where the first station's frame lies in the plant</source>
            <translation>Where the first station's frame lies in the plant</translation>
        </message>
        <message>
            <source>Where the station's level frame lies in the document's frame</source>
            <translation>Where the station's level frame lies in the document's frame</translation>
        </message>
        <message>
            <source>Why components stay bare</source>
            <translation>Why components stay bare</translation>
        </message>
        <message>
            <source>station.json with the calibration, relative to the document</source>
            <translation>station.json with the calibration, relative to the document</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Adjust</name>
        <message>
            <source>Adjust</source>
            <translation>Adjust</translation>
        </message>
        <message>
            <source>Adjust pipes and fittings, all or those selected, to the edges of all photographs, with their joints and standard sizes</source>
            <translation>Adjust pipes and fittings, all or those selected, to the edges of all photographs, with their joints and standard sizes</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Deviations</name>
        <message>
            <source>Deviations</source>
            <translation>Deviations</translation>
        </message>
        <message>
            <source>Measure how pipes and fittings deviate from a design: an IFC model, or solids of the document</source>
            <translation>Measure how pipes and fittings deviate from a design: an IFC model, or solids of the document</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Elbows</name>
        <message>
            <source>Elbows</source>
            <translation>Elbows</translation>
        </message>
        <message>
            <source>Find the elbows between the pipes, or between two selected pipes, and choose their bend radius</source>
            <translation>Find the elbows between the pipes, or between two selected pipes, and choose their bend radius</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ExampleProject</name>
        <message>
            <source>Example project: dummy station</source>
            <translation>Example project: dummy station</translation>
        </message>
        <message>
            <source>Open an example with photographs, and a guide through the first steps</source>
            <translation>Open an example with photographs, and a guide through the first steps</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Export</name>
        <message>
            <source>Export</source>
            <translation>Export</translation>
        </message>
        <message>
            <source>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV, as a report or as a picture</source>
            <translation>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV, as a report or as a picture</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_FindPipes</name>
        <message>
            <source>Find Pipes</source>
            <translation>Find Pipes</translation>
        </message>
        <message>
            <source>Look for pipes in the whole station without any click; each is proposed and accepted or rejected</source>
            <translation>Look for pipes in the whole station without any click; each is proposed and accepted or rejected</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Fittings</name>
        <message>
            <source>Find tees, reducers and caps at the pipes, or at the selected pipes</source>
            <translation>Find tees, reducers and caps at the pipes, or at the selected pipes</translation>
        </message>
        <message>
            <source>Tees, Reducers and Caps</source>
            <translation>Tees, Reducers and Caps</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Flange</name>
        <message>
            <source>Flange</source>
            <translation>Flange</translation>
        </message>
        <message>
            <source>Measure a flange: click on the straight edge of its rim; or give the selected flange another type</source>
            <translation>Measure a flange: click on the straight edge of its rim; or give the selected flange another type</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ImportStation</name>
        <message>
            <source>Import Station</source>
            <translation>Import Station</translation>
        </message>
        <message>
            <source>Import the photographs and the calibration of a station (station.json)</source>
            <translation>Import the photographs and the calibration of a station (station.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Insulation</name>
        <message>
            <source>Insulate pipes and fittings (all, or those selected): layers, jacket, boxes over flanges, heat saved, sheets to cut</source>
            <translation>Insulate pipes and fittings (all, or those selected): layers, jacket, boxes over flanges, heat saved, sheets to cut</translation>
        </message>
        <message>
            <source>Insulation</source>
            <translation>Insulation</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_MergeStations</name>
        <message>
            <source>Merge Stations</source>
            <translation>Merge Stations</translation>
        </message>
        <message>
            <source>Put several stations together over the pipes and fittings they share, and adjust them over all photographs</source>
            <translation>Put several stations together over the pipes and fittings they share, and adjust them over all photographs</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_PhotoWindow</name>
        <message>
            <source>Photo Window</source>
            <translation>Photo Window</translation>
        </message>
        <message>
            <source>Show the station's photographs side by side, with the contours of pipes and fittings</source>
            <translation>Show the station's photographs side by side, with the contours of pipes and fittings</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Pipe</name>
        <message>
            <source>Measure a pipe: one click inside it or one on each of its edges in a photograph</source>
            <translation>Measure a pipe: one click inside it or one on each of its edges in a photograph</translation>
        </message>
        <message>
            <source>Pipe</source>
            <translation>Pipe</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Preferences</name>
        <message>
            <source>Preferences ...</source>
            <translation>Preferences ...</translation>
        </message>
        <message>
            <source>Tables of your own, working range, tolerances, colours and threads</source>
            <translation>Tables of your own, working range, tolerances, colours and threads</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ReconstructPicks</name>
        <message>
            <source>Reconstruct Picks</source>
            <translation>Reconstruct Picks</translation>
        </message>
        <message>
            <source>Reconstruct the pipes that were picked in the station's photographs (picks.json)</source>
            <translation>Reconstruct the pipes that were picked in the station's photographs (picks.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Report</name>
        <message>
            <source>Report</source>
            <translation>Report</translation>
        </message>
        <message>
            <source>Write a report of what was measured and how well, with charts and photographs, and open it in the browser</source>
            <translation>Write a report of what was measured and how well, with charts and photographs, and open it in the browser</translation>
        </message>
    </context>
    <context>
        <name>PipeWorkbench</name>
        <message>
            <source>'{panel}' has results that are not applied. Close it without applying them?</source>
            <translation>'{panel}' has results that are not applied. Close it without applying them?</translation>
        </message>
        <message>
            <source>'{panel}' is still open</source>
            <translation>'{panel}' is still open</translation>
        </message>
        <message>
            <source>... and {count} more</source>
            <translation>... and {count} more</translation>
        </message>
        <message>
            <source>0 indoors</source>
            <translation>0 indoors</translation>
        </message>
        <message>
            <source>&lt;b&gt;Station {frame}&lt;/b&gt;: σ₀ {sigma0}, edges ± {sigma} px, redundancy {redundancy}, {count} iterations, {ended}</source>
            <translation>&lt;b&gt;Station {frame}&lt;/b&gt;: σ₀ {sigma0}, edges ± {sigma} px, redundancy {redundancy}, {count} iterations, {ended}</translation>
        </message>
        <message>
            <source>&lt;b&gt;{stations}&lt;/b&gt; become one: {pairs} pairs, {count} components, σ₀ {sigma0}</source>
            <translation>&lt;b&gt;{stations}&lt;/b&gt; become one: {pairs} pairs, {count} components, σ₀ {sigma0}</translation>
        </message>
        <message>
            <source>A click is</source>
            <translation>A click is</translation>
        </message>
        <message>
            <source>A component that several insulations hold has the last one</source>
            <translation>A component that several insulations hold has the last one</translation>
        </message>
        <message>
            <source>A file that is there is replaced</source>
            <translation>A file that is there is replaced</translation>
        </message>
        <message>
            <source>A fixed one, or what it follows from: a table, the heat a metre may lose, ...</source>
            <translation>A fixed one, or what it follows from: a table, the heat a metre may lose, ...</translation>
        </message>
        <message>
            <source>A folder with tables of your own</source>
            <translation>A folder with tables of your own</translation>
        </message>
        <message>
            <source>A pipe whose measured diameter differs by more from the standard's is marked as approximate</source>
            <translation>A pipe whose measured diameter differs by more from the standard's is marked as approximate</translation>
        </message>
        <message>
            <source>A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.</source>
            <translation>A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.</translation>
        </message>
        <message>
            <source>A weak condition: what the images say clearly is stronger</source>
            <translation>A weak condition: what the images say clearly is stronger</translation>
        </message>
        <message>
            <source>Accept</source>
            <translation>Accept</translation>
        </message>
        <message>
            <source>Accept the {count} ticked</source>
            <translation>Accept the {count} ticked</translation>
        </message>
        <message>
            <source>Add ...</source>
            <translation>Add ...</translation>
        </message>
        <message>
            <source>Add a flange</source>
            <translation>Add a flange</translation>
        </message>
        <message>
            <source>Add a folder with tables</source>
            <translation>Add a folder with tables</translation>
        </message>
        <message>
            <source>Add the flange on the other side of the gasket as well, where one is seen</source>
            <translation>Add the flange on the other side of the gasket as well, where one is seen</translation>
        </message>
        <message>
            <source>Adjust</source>
            <translation>Adjust</translation>
        </message>
        <message>
            <source>Adjust everything</source>
            <translation>Adjust everything</translation>
        </message>
        <message>
            <source>Adjust over all photographs</source>
            <translation>Adjust over all photographs</translation>
        </message>
        <message>
            <source>Adjustment</source>
            <translation>Adjustment</translation>
        </message>
        <message>
            <source>All components and the stations' places at once; takes some seconds per station</source>
            <translation>All components and the stations' places at once; takes some seconds per station</translation>
        </message>
        <message>
            <source>All that are checked are merged into the frame of the reference</source>
            <translation>All that are checked are merged into the frame of the reference</translation>
        </message>
        <message>
            <source>An IFC model with the pipes as designed, as IfcPipeSegment</source>
            <translation>An IFC model with the pipes as designed, as IfcPipeSegment</translation>
        </message>
        <message>
            <source>An arrow from each contour point that counts to its edge, enlarged by the window's slider</source>
            <translation>An arrow from each contour point that counts to its edge, enlarged by the window's slider</translation>
        </message>
        <message>
            <source>Angle</source>
            <translation>Angle</translation>
        </message>
        <message>
            <source>Angle °</source>
            <translation>Angle °</translation>
        </message>
        <message>
            <source>Approximate from a deviation of</source>
            <translation>Approximate from a deviation of</translation>
        </message>
        <message>
            <source>Approximate pipe</source>
            <translation>Approximate pipe</translation>
        </message>
        <message>
            <source>Around what is insulated in the document</source>
            <translation>Around what is insulated in the document</translation>
        </message>
        <message>
            <source>As built</source>
            <translation>As built</translation>
        </message>
        <message>
            <source>As built; in red where the design has another, which the tooltip tells</source>
            <translation>As built; in red where the design has another, which the tooltip tells</translation>
        </message>
        <message>
            <source>As designed</source>
            <translation>As designed</translation>
        </message>
        <message>
            <source>Assign Selected</source>
            <translation>Assign Selected</translation>
        </message>
        <message>
            <source>Assigned by hand: {pairs}</source>
            <translation>Assigned by hand: {pairs}</translation>
        </message>
        <message>
            <source>At</source>
            <translation>At</translation>
        </message>
        <message>
            <source>At most</source>
            <translation>At most</translation>
        </message>
        <message>
            <source>Bad</source>
            <translation>Bad</translation>
        </message>
        <message>
            <source>Bend</source>
            <translation>Bend</translation>
        </message>
        <message>
            <source>Bend radius of the chosen elbow: one of the standard, or a free one</source>
            <translation>Bend radius of the chosen elbow: one of the standard, or a free one</translation>
        </message>
        <message>
            <source>Bends</source>
            <translation>Bends</translation>
        </message>
        <message>
            <source>Bends, flanges</source>
            <translation>Bends, flanges</translation>
        </message>
        <message>
            <source>Between</source>
            <translation>Between</translation>
        </message>
        <message>
            <source>Between a flange's rim and the inside of its box</source>
            <translation>Between a flange's rim and the inside of its box</translation>
        </message>
        <message>
            <source>Between both after the adjustment of the stations' places; of pipes the larger of both ends</source>
            <translation>Between both after the adjustment of the stations' places; of pipes the larger of both ends</translation>
        </message>
        <message>
            <source>Between both axes</source>
            <translation>Between both axes</translation>
        </message>
        <message>
            <source>Between the faces of two flanges that are bolted together</source>
            <translation>Between the faces of two flanges that are bolted together</translation>
        </message>
        <message>
            <source>Boxes of two half shells, or nothing</source>
            <translation>Boxes of two half shells, or nothing</translation>
        </message>
        <message>
            <source>Brightens the dark parts to the right, darkens to the left</source>
            <translation>Brightens the dark parts to the right, darkens to the left</translation>
        </message>
        <message>
            <source>Brightness</source>
            <translation>Brightness</translation>
        </message>
        <message>
            <source>By</source>
            <translation>By</translation>
        </message>
        <message>
            <source>CO2</source>
            <translation>CO2</translation>
        </message>
        <message>
            <source>CO2 kg/a</source>
            <translation>CO2 kg/a</translation>
        </message>
        <message>
            <source>Cancel</source>
            <translation>Cancel</translation>
        </message>
        <message>
            <source>Cancelling: waiting for the end of this step ...</source>
            <translation>Cancelling: waiting for the end of this step ...</translation>
        </message>
        <message>
            <source>Cap</source>
            <translation>Cap</translation>
        </message>
        <message>
            <source>Change the insulation</source>
            <translation>Change the insulation</translation>
        </message>
        <message>
            <source>Choose another type for {name}; its face stays where it is.</source>
            <translation>Choose another type for {name}; its face stays where it is.</translation>
        </message>
        <message>
            <source>Choose folder and name</source>
            <translation>Choose folder and name</translation>
        </message>
        <message>
            <source>Choose one of the places it fits at ...</source>
            <translation>Choose one of the places it fits at ...</translation>
        </message>
        <message>
            <source>Choose the file</source>
            <translation>Choose the file</translation>
        </message>
        <message>
            <source>Choose the folder that the photographs are in now</source>
            <translation>Choose the folder that the photographs are in now</translation>
        </message>
        <message>
            <source>Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all photographs; Enter accepts it, digits choose another proposal, Esc steps back.</source>
            <translation>Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all photographs; Enter accepts it, digits choose another proposal, Esc steps back.</translation>
        </message>
        <message>
            <source>Clear</source>
            <translation>Clear</translation>
        </message>
        <message>
            <source>Clearance</source>
            <translation>Clearance</translation>
        </message>
        <message>
            <source>Click again, change the diameter, or step back with Esc.</source>
            <translation>Click again, change the diameter, or step back with Esc.</translation>
        </message>
        <message>
            <source>Click inside a pipe, or on one of its edges.</source>
            <translation>Click inside a pipe, or on one of its edges.</translation>
        </message>
        <message>
            <source>Click on a proposal to choose it; Enter accepts it, Esc leaves</source>
            <translation>Click on a proposal to choose it; Enter accepts it, Esc leaves</translation>
        </message>
        <message>
            <source>Click on the other edge of the pipe, in the same photograph.</source>
            <translation>Click on the other edge of the pipe, in the same photograph.</translation>
        </message>
        <message>
            <source>Click on the straight edge of a flange's rim, then choose its type and pressure class from those that fit; Enter accepts it.</source>
            <translation>Click on the straight edge of a flange's rim, then choose its type and pressure class from those that fit; Enter accepts it.</translation>
        </message>
        <message>
            <source>Click on the straight edge of a flange's rim. Its pipe must have been measured.</source>
            <translation>Click on the straight edge of a flange's rim. Its pipe must have been measured.</translation>
        </message>
        <message>
            <source>Click to choose another colour</source>
            <translation>Click to choose another colour</translation>
        </message>
        <message>
            <source>Close the guide; the document stays open</source>
            <translation>Close the guide; the document stays open</translation>
        </message>
        <message>
            <source>Colours</source>
            <translation>Colours</translation>
        </message>
        <message>
            <source>Colours in 3D</source>
            <translation>Colours in 3D</translation>
        </message>
        <message>
            <source>Colours of the contours</source>
            <translation>Colours of the contours</translation>
        </message>
        <message>
            <source>Colours of the contours and length of the residuals</source>
            <translation>Colours of the contours and length of the residuals</translation>
        </message>
        <message>
            <source>Compare</source>
            <translation>Compare</translation>
        </message>
        <message>
            <source>Compare with</source>
            <translation>Compare with</translation>
        </message>
        <message>
            <source>Component</source>
            <translation>Component</translation>
        </message>
        <message>
            <source>Components</source>
            <translation>Components</translation>
        </message>
        <message>
            <source>Components that are fixed, or not selected, stay where they are</source>
            <translation>Components that are fixed, or not selected, stay where they are</translation>
        </message>
        <message>
            <source>Compute the adjustment; the document stays as it is until you apply it</source>
            <translation>Compute the adjustment; the document stays as it is until you apply it</translation>
        </message>
        <message>
            <source>Computer</source>
            <translation>Computer</translation>
        </message>
        <message>
            <source>Confidence</source>
            <translation>Confidence</translation>
        </message>
        <message>
            <source>Contours</source>
            <translation>Contours</translation>
        </message>
        <message>
            <source>Contours of the pipes and fittings</source>
            <translation>Contours of the pipes and fittings</translation>
        </message>
        <message>
            <source>Contrast</source>
            <translation>Contrast</translation>
        </message>
        <message>
            <source>Contrast and brightness of the photographs</source>
            <translation>Contrast and brightness of the photographs</translation>
        </message>
        <message>
            <source>Contrast of the photographs</source>
            <translation>Contrast of the photographs</translation>
        </message>
        <message>
            <source>Cost/a</source>
            <translation>Cost/a</translation>
        </message>
        <message>
            <source>Cut and material lists</source>
            <translation>Cut and material lists</translation>
        </message>
        <message>
            <source>Cut list</source>
            <translation>Cut list</translation>
        </message>
        <message>
            <source>Cut list...</source>
            <translation>Cut list...</translation>
        </message>
        <message>
            <source>Cut sheets</source>
            <translation>Cut sheets</translation>
        </message>
        <message>
            <source>Cut sheets...</source>
            <translation>Cut sheets...</translation>
        </message>
        <message>
            <source>D {D:g} mm, C {C:g} mm, length {length:g} mm</source>
            <translation>D {D:g} mm, C {C:g} mm, length {length:g} mm</translation>
        </message>
        <message>
            <source>Dash what is hidden</source>
            <translation>Dash what is hidden</translation>
        </message>
        <message>
            <source>Deviations</source>
            <translation>Deviations</translation>
        </message>
        <message>
            <source>Diameter</source>
            <translation>Diameter</translation>
        </message>
        <message>
            <source>Diameter mm</source>
            <translation>Diameter mm</translation>
        </message>
        <message>
            <source>Diameters, bend radii and flange dimensions of standards; sizes that are no standard's are always measured</source>
            <translation>Diameters, bend radii and flange dimensions of standards; sizes that are no standard's are always measured</translation>
        </message>
        <message>
            <source>Display</source>
            <translation>Display</translation>
        </message>
        <message>
            <source>Distance</source>
            <translation>Distance</translation>
        </message>
        <message>
            <source>Distance [mm]</source>
            <translation>Distance [mm]</translation>
        </message>
        <message>
            <source>Distance mm</source>
            <translation>Distance mm</translation>
        </message>
        <message>
            <source>Distance of the farthest pipes from the cameras</source>
            <translation>Distance of the farthest pipes from the cameras</translation>
        </message>
        <message>
            <source>Distance of the nearest pipes from the cameras</source>
            <translation>Distance of the nearest pipes from the cameras</translation>
        </message>
        <message>
            <source>Down</source>
            <translation>Down</translation>
        </message>
        <message>
            <source>Drag to make the pipe thicker or thinner: it moves away or nearer, so that its clicked edges stay</source>
            <translation>Drag to make the pipe thicker or thinner: it moves away or nearer, so that its clicked edges stay</translation>
        </message>
        <message>
            <source>Edges</source>
            <translation>Edges</translation>
        </message>
        <message>
            <source>Edges %</source>
            <translation>Edges %</translation>
        </message>
        <message>
            <source>Edges found in the photographs, with subpixel accuracy</source>
            <translation>Edges found in the photographs, with subpixel accuracy</translation>
        </message>
        <message>
            <source>Edges within</source>
            <translation>Edges within</translation>
        </message>
        <message>
            <source>Efficiency</source>
            <translation>Efficiency</translation>
        </message>
        <message>
            <source>Elbow</source>
            <translation>Elbow</translation>
        </message>
        <message>
            <source>Elbows</source>
            <translation>Elbows</translation>
        </message>
        <message>
            <source>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs, Enter accepts it.</source>
            <translation>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs, Enter accepts it.</translation>
        </message>
        <message>
            <source>Else all components are compared</source>
            <translation>Else all components are compared</translation>
        </message>
        <message>
            <source>End the tour</source>
            <translation>End the tour</translation>
        </message>
        <message>
            <source>Ends that face each other and are not farther apart are joined</source>
            <translation>Ends that face each other and are not farther apart are joined</translation>
        </message>
        <message>
            <source>Energy that is bought for it in a year</source>
            <translation>Energy that is bought for it in a year</translation>
        </message>
        <message>
            <source>Enlarge the pixels around the pointer (L)</source>
            <translation>Enlarge the pixels around the pointer (L)</translation>
        </message>
        <message>
            <source>Enter accepts the flange. Choose another type if it is not the right one.</source>
            <translation>Enter accepts the flange. Choose another type if it is not the right one.</translation>
        </message>
        <message>
            <source>Enter accepts the pipe. Digits choose another one. Esc steps back.</source>
            <translation>Enter accepts the pipe. Digits choose another one. Esc steps back.</translation>
        </message>
        <message>
            <source>Everything that is known, for this program's command line</source>
            <translation>Everything that is known, for this program's command line</translation>
        </message>
        <message>
            <source>Exactly as in the standard</source>
            <translation>Exactly as in the standard</translation>
        </message>
        <message>
            <source>Example project</source>
            <translation>Example project</translation>
        </message>
        <message>
            <source>Export</source>
            <translation>Export</translation>
        </message>
        <message>
            <source>Export it</source>
            <translation>Export it</translation>
        </message>
        <message>
            <source>Fair</source>
            <translation>Fair</translation>
        </message>
        <message>
            <source>Fair up to</source>
            <translation>Fair up to</translation>
        </message>
        <message>
            <source>File</source>
            <translation>File</translation>
        </message>
        <message>
            <source>Find Photographs</source>
            <translation>Find Photographs</translation>
        </message>
        <message>
            <source>Find Pipes</source>
            <translation>Find Pipes</translation>
        </message>
        <message>
            <source>Find What They Share</source>
            <translation>Find What They Share</translation>
        </message>
        <message>
            <source>Find them...</source>
            <translation>Find them...</translation>
        </message>
        <message>
            <source>Finding pipes</source>
            <translation>Finding pipes</translation>
        </message>
        <message>
            <source>First and last</source>
            <translation>First and last</translation>
        </message>
        <message>
            <source>First steps</source>
            <translation>First steps</translation>
        </message>
        <message>
            <source>Fit</source>
            <translation>Fit</translation>
        </message>
        <message>
            <source>Fit the model to the pipework</source>
            <translation>Fit the model to the pipework</translation>
        </message>
        <message>
            <source>Fix the outside diameter; the projection follows, and the pipe is measured with it</source>
            <translation>Fix the outside diameter; the projection follows, and the pipe is measured with it</translation>
        </message>
        <message>
            <source>Fixed at</source>
            <translation>Fixed at</translation>
        </message>
        <message>
            <source>Flange</source>
            <translation>Flange</translation>
        </message>
        <message>
            <source>Flange: click on the straight edge of its rim</source>
            <translation>Flange: click on the straight edge of its rim</translation>
        </message>
        <message>
            <source>Flanges</source>
            <translation>Flanges</translation>
        </message>
        <message>
            <source>Folder with the photographs</source>
            <translation>Folder with the photographs</translation>
        </message>
        <message>
            <source>Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'</source>
            <translation>Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'</translation>
        </message>
        <message>
            <source>For BIM: pipe segments and fittings with their dimensions and accuracy</source>
            <translation>For BIM: pipe segments and fittings with their dimensions and accuracy</translation>
        </message>
        <message>
            <source>For CAD: named solids, coloured by kind</source>
            <translation>For CAD: named solids, coloured by kind</translation>
        </message>
        <message>
            <source>For estimating and purchasing: a line per item with its quantity</source>
            <translation>For estimating and purchasing: a line per item with its quantity</translation>
        </message>
        <message>
            <source>For isometrics: components with their ends, bores and items</source>
            <translation>For isometrics: components with their ends, bores and items</translation>
        </message>
        <message>
            <source>For people: one file with dimensions, accuracy, charts and photographs</source>
            <translation>For people: one file with dimensions, accuracy, charts and photographs</translation>
        </message>
        <message>
            <source>For spreadsheets: a line per component</source>
            <translation>For spreadsheets: a line per component</translation>
        </message>
        <message>
            <source>For the shop and purchasing: parts, sheets and materials of the insulation</source>
            <translation>For the shop and purchasing: parts, sheets and materials of the insulation</translation>
        </message>
        <message>
            <source>For the shop: the insulation's parts of sheet metal, laid out on sheets</source>
            <translation>For the shop: the insulation's parts of sheet metal, laid out on sheets</translation>
        </message>
        <message>
            <source>Forget</source>
            <translation>Forget</translation>
        </message>
        <message>
            <source>Forget the click</source>
            <translation>Forget the click</translation>
        </message>
        <message>
            <source>Forget the clicks</source>
            <translation>Forget the clicks</translation>
        </message>
        <message>
            <source>Format</source>
            <translation>Format</translation>
        </message>
        <message>
            <source>Free bend radius; the projection follows</source>
            <translation>Free bend radius; the projection follows</translation>
        </message>
        <message>
            <source>Free, as measured</source>
            <translation>Free, as measured</translation>
        </message>
        <message>
            <source>From</source>
            <translation>From</translation>
        </message>
        <message>
            <source>From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again.</source>
            <translation>From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again.</translation>
        </message>
        <message>
            <source>From the design to what was built</source>
            <translation>From the design to what was built</translation>
        </message>
        <message>
            <source>Gamma</source>
            <translation>Gamma</translation>
        </message>
        <message>
            <source>Gasket</source>
            <translation>Gasket</translation>
        </message>
        <message>
            <source>Good</source>
            <translation>Good</translation>
        </message>
        <message>
            <source>Good up to</source>
            <translation>Good up to</translation>
        </message>
        <message>
            <source>Green within the first limit, yellow up to the second, red beyond; grey has no counterpart</source>
            <translation>Green within the first limit, yellow up to the second, red beyond; grey has no counterpart</translation>
        </message>
        <message>
            <source>Heading</source>
            <translation>Heading</translation>
        </message>
        <message>
            <source>Heat W</source>
            <translation>Heat W</translation>
        </message>
        <message>
            <source>Heat delivered over energy bought: 0.9 of a boiler, 3 of a heat pump</source>
            <translation>Heat delivered over energy bought: 0.9 of a boiler, 3 of a heat pump</translation>
        </message>
        <message>
            <source>Heat that a metre of pipe may lose, or temperature of the surface</source>
            <translation>Heat that a metre of pipe may lose, or temperature of the surface</translation>
        </message>
        <message>
            <source>Hours in a year</source>
            <translation>Hours in a year</translation>
        </message>
        <message>
            <source>How far from the contours edges are looked for: more where components lie beside their pictures</source>
            <translation>How far from the contours edges are looked for: more where components lie beside their pictures</translation>
        </message>
        <message>
            <source>How far its axis turns</source>
            <translation>How far its axis turns</translation>
        </message>
        <message>
            <source>How far its middle moves; of pipes across their axis</source>
            <translation>How far its middle moves; of pipes across their axis</translation>
        </message>
        <message>
            <source>How long the first and the last piece of a bend are</source>
            <translation>How long the first and the last piece of a bend are</translation>
        </message>
        <message>
            <source>How many parts of the processor are used at most</source>
            <translation>How many parts of the processor are used at most</translation>
        </message>
        <message>
            <source>How many times their length residuals are drawn</source>
            <translation>How many times their length residuals are drawn</translation>
        </message>
        <message>
            <source>How near to an edge the pointer must be, in pixels of the screen</source>
            <translation>How near to an edge the pointer must be, in pixels of the screen</translation>
        </message>
        <message>
            <source>How the adjustment treats diameters and bend radii of the standards</source>
            <translation>How the adjustment treats diameters and bend radii of the standards</translation>
        </message>
        <message>
            <source>IFC</source>
            <translation>IFC</translation>
        </message>
        <message>
            <source>IFC4 is what most programs read</source>
            <translation>IFC4 is what most programs read</translation>
        </message>
        <message>
            <source>Import a station</source>
            <translation>Import a station</translation>
        </message>
        <message>
            <source>In the browser</source>
            <translation>In the browser</translation>
        </message>
        <message>
            <source>In the document: {names}</source>
            <translation>In the document: {names}</translation>
        </message>
        <message>
            <source>In the station that was there before</source>
            <translation>In the station that was there before</translation>
        </message>
        <message>
            <source>Insulate</source>
            <translation>Insulate</translation>
        </message>
        <message>
            <source>Insulation</source>
            <translation>Insulation</translation>
        </message>
        <message>
            <source>Insulation, a bare component or an obstacle</source>
            <translation>Insulation, a bare component or an obstacle</translation>
        </message>
        <message>
            <source>Jacket</source>
            <translation>Jacket</translation>
        </message>
        <message>
            <source>Join ends up to</source>
            <translation>Join ends up to</translation>
        </message>
        <message>
            <source>Joints to components that are left out are left out, too</source>
            <translation>Joints to components that are left out are left out, too</translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>Kind</translation>
        </message>
        <message>
            <source>Kinds of components</source>
            <translation>Kinds of components</translation>
        </message>
        <message>
            <source>LOA</source>
            <translation>LOA</translation>
        </message>
        <message>
            <source>Language</source>
            <translation>Language</translation>
        </message>
        <message>
            <source>Largest distance {distance:.1f} mm.</source>
            <translation>Largest distance {distance:.1f} mm.</translation>
        </message>
        <message>
            <source>Layers</source>
            <translation>Layers</translation>
        </message>
        <message>
            <source>Leave the specification's rules and obstacles away</source>
            <translation>Leave the specification's rules and obstacles away</translation>
        </message>
        <message>
            <source>Length</source>
            <translation>Length</translation>
        </message>
        <message>
            <source>Length of the residuals</source>
            <translation>Length of the residuals</translation>
        </message>
        <message>
            <source>Level of accuracy (USIBD)</source>
            <translation>Level of accuracy (USIBD)</translation>
        </message>
        <message>
            <source>Level, plumb and square runs</source>
            <translation>Level, plumb and square runs</translation>
        </message>
        <message>
            <source>Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier</source>
            <translation>Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier</translation>
        </message>
        <message>
            <source>Loading the photograph...</source>
            <translation>Loading the photograph...</translation>
        </message>
        <message>
            <source>Longer by</source>
            <translation>Longer by</translation>
        </message>
        <message>
            <source>Look how the stations lie to each other; the document stays as it is until you press OK</source>
            <translation>Look how the stations lie to each other; the document stays as it is until you press OK</translation>
        </message>
        <message>
            <source>Looking ...</source>
            <translation>Looking ...</translation>
        </message>
        <message>
            <source>Looking for more ...</source>
            <translation>Looking for more ...</translation>
        </message>
        <message>
            <source>Looking for the rim ...</source>
            <translation>Looking for the rim ...</translation>
        </message>
        <message>
            <source>Loupe</source>
            <translation>Loupe</translation>
        </message>
        <message>
            <source>Material</source>
            <translation>Material</translation>
        </message>
        <message>
            <source>Material of a layer around the first</source>
            <translation>Material of a layer around the first</translation>
        </message>
        <message>
            <source>Measure a pipe</source>
            <translation>Measure a pipe</translation>
        </message>
        <message>
            <source>Measure the deviations; the document stays as it is</source>
            <translation>Measure the deviations; the document stays as it is</translation>
        </message>
        <message>
            <source>Measure the next pipe</source>
            <translation>Measure the next pipe</translation>
        </message>
        <message>
            <source>Measure the pipe that goes on behind a bend of the first one; the tool stays open for it.</source>
            <translation>Measure the pipe that goes on behind a bend of the first one; the tool stays open for it.</translation>
        </message>
        <message>
            <source>Measuring</source>
            <translation>Measuring</translation>
        </message>
        <message>
            <source>Measuring ...</source>
            <translation>Measuring ...</translation>
        </message>
        <message>
            <source>Medium</source>
            <translation>Medium</translation>
        </message>
        <message>
            <source>Merge Stations</source>
            <translation>Merge Stations</translation>
        </message>
        <message>
            <source>Move the chosen folder down: its tables come before those above</source>
            <translation>Move the chosen folder down: its tables come before those above</translation>
        </message>
        <message>
            <source>Move the chosen folder up</source>
            <translation>Move the chosen folder up</translation>
        </message>
        <message>
            <source>Next</source>
            <translation>Next</translation>
        </message>
        <message>
            <source>No elbows are seen between the free ends of the pipes. Measure the pipes on both sides of a bend, or select two pipes.</source>
            <translation>No elbows are seen between the free ends of the pipes. Measure the pipes on both sides of a bend, or select two pipes.</translation>
        </message>
        <message>
            <source>No further pipes are seen. Click on those that are missing with the Pipe tool.</source>
            <translation>No further pipes are seen. Click on those that are missing with the Pipe tool.</translation>
        </message>
        <message>
            <source>No tees, reducers or caps are seen at the free ends of the pipes. Select the pipes that belong to one.</source>
            <translation>No tees, reducers or caps are seen at the free ends of the pipes. Select the pipes that belong to one.</translation>
        </message>
        <message>
            <source>None: everything is determined and nothing is weakly placed.</source>
            <translation>None: everything is determined and nothing is weakly placed.</translation>
        </message>
        <message>
            <source>Not measured</source>
            <translation>Not measured</translation>
        </message>
        <message>
            <source>Note</source>
            <translation>Note</translation>
        </message>
        <message>
            <source>Nothing is insulated yet: use Insulation first.</source>
            <translation>Nothing is insulated yet: use Insulation first.</translation>
        </message>
        <message>
            <source>Of a segmented bend</source>
            <translation>Of a segmented bend</translation>
        </message>
        <message>
            <source>Of operation</source>
            <translation>Of operation</translation>
        </message>
        <message>
            <source>Of straight pieces of sheet metal, or round as foam shells are</source>
            <translation>Of straight pieces of sheet metal, or round as foam shells are</translation>
        </message>
        <message>
            <source>Of the axes, the larger of both ends of what they have in common; of surfaces the shortest</source>
            <translation>Of the axes, the larger of both ends of what they have in common; of surfaces the shortest</translation>
        </message>
        <message>
            <source>Of the distances between contours and edges</source>
            <translation>Of the distances between contours and edges</translation>
        </message>
        <message>
            <source>Of the energy that is bought</source>
            <translation>Of the energy that is bought</translation>
        </message>
        <message>
            <source>Of the finished surfaces; negative where they overlap</source>
            <translation>Of the finished surfaces; negative where they overlap</translation>
        </message>
        <message>
            <source>Of the inner layer</source>
            <translation>Of the inner layer</translation>
        </message>
        <message>
            <source>Of the texts in the file</source>
            <translation>Of the texts in the file</translation>
        </message>
        <message>
            <source>Open it afterwards</source>
            <translation>Open it afterwards</translation>
        </message>
        <message>
            <source>Open its photo window</source>
            <translation>Open its photo window</translation>
        </message>
        <message>
            <source>Operation</source>
            <translation>Operation</translation>
        </message>
        <message>
            <source>Otherwise selected components follow their own edges, and gaps may open to their neighbours</source>
            <translation>Otherwise selected components follow their own edges, and gaps may open to their neighbours</translation>
        </message>
        <message>
            <source>Outliers</source>
            <translation>Outliers</translation>
        </message>
        <message>
            <source>Outliers from</source>
            <translation>Outliers from</translation>
        </message>
        <message>
            <source>Outside diameters from</source>
            <translation>Outside diameters from</translation>
        </message>
        <message>
            <source>Part of the contours' samples that have an edge</source>
            <translation>Part of the contours' samples that have an edge</translation>
        </message>
        <message>
            <source>Photograph</source>
            <translation>Photograph</translation>
        </message>
        <message>
            <source>Photographs</source>
            <translation>Photographs</translation>
        </message>
        <message>
            <source>Photographs with contours</source>
            <translation>Photographs with contours</translation>
        </message>
        <message>
            <source>Pick {index} failed: {reason}.</source>
            <translation>Pick {index} failed: {reason}.</translation>
        </message>
        <message>
            <source>Picks</source>
            <translation>Picks</translation>
        </message>
        <message>
            <source>Pictures of the cut sheets</source>
            <translation>Pictures of the cut sheets</translation>
        </message>
        <message>
            <source>Pieces</source>
            <translation>Pieces</translation>
        </message>
        <message>
            <source>Pipe</source>
            <translation>Pipe</translation>
        </message>
        <message>
            <source>Pipe Workbench pipeline</source>
            <translation>Pipe Workbench pipeline</translation>
        </message>
        <message>
            <source>Pipe: click inside it, or on both its edges</source>
            <translation>Pipe: click inside it, or on both its edges</translation>
        </message>
        <message>
            <source>Pipes from</source>
            <translation>Pipes from</translation>
        </message>
        <message>
            <source>Pipes of an IFC file</source>
            <translation>Pipes of an IFC file</translation>
        </message>
        <message>
            <source>Pipes of selected solids</source>
            <translation>Pipes of selected solids</translation>
        </message>
        <message>
            <source>Pipes that are nearly level, plumb or at right angles are so</source>
            <translation>Pipes that are nearly level, plumb or at right angles are so</translation>
        </message>
        <message>
            <source>Piping component file</source>
            <translation>Piping component file</translation>
        </message>
        <message>
            <source>Poor</source>
            <translation>Poor</translation>
        </message>
        <message>
            <source>Poor up to</source>
            <translation>Poor up to</translation>
        </message>
        <message>
            <source>Preview</source>
            <translation>Preview</translation>
        </message>
        <message>
            <source>Price</source>
            <translation>Price</translation>
        </message>
        <message>
            <source>Put all that are ticked into the document</source>
            <translation>Put all that are ticked into the document</translation>
        </message>
        <message>
            <source>Put the chosen one into the document (Enter)</source>
            <translation>Put the chosen one into the document (Enter)</translation>
        </message>
        <message>
            <source>Put the chosen pipe into the document (Enter)</source>
            <translation>Put the chosen pipe into the document (Enter)</translation>
        </message>
        <message>
            <source>Put the elbow between them</source>
            <translation>Put the elbow between them</translation>
        </message>
        <message>
            <source>Put the flange into the document (Enter)</source>
            <translation>Put the flange into the document (Enter)</translation>
        </message>
        <message>
            <source>Quality</source>
            <translation>Quality</translation>
        </message>
        <message>
            <source>Quality is the root mean square distance of a component's contour from the edges in the photographs</source>
            <translation>Quality is the root mean square distance of a component's contour from the edges in the photographs</translation>
        </message>
        <message>
            <source>RMS distance of its contours to the edges (Eq. 4) before and after</source>
            <translation>RMS distance of its contours to the edges (Eq. 4) before and after</translation>
        </message>
        <message>
            <source>RMS px</source>
            <translation>RMS px</translation>
        </message>
        <message>
            <source>Radius</source>
            <translation>Radius</translation>
        </message>
        <message>
            <source>Read layers, rules for single components, obstacles</source>
            <translation>Read layers, rules for single components, obstacles</translation>
        </message>
        <message>
            <source>Reconstruct picks</source>
            <translation>Reconstruct picks</translation>
        </message>
        <message>
            <source>Reconstructing picks</source>
            <translation>Reconstructing picks</translation>
        </message>
        <message>
            <source>Reducer</source>
            <translation>Reducer</translation>
        </message>
        <message>
            <source>Reference</source>
            <translation>Reference</translation>
        </message>
        <message>
            <source>Reject</source>
            <translation>Reject</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Remove</translation>
        </message>
        <message>
            <source>Report</source>
            <translation>Report</translation>
        </message>
        <message>
            <source>Reset</source>
            <translation>Reset</translation>
        </message>
        <message>
            <source>Residuals</source>
            <translation>Residuals</translation>
        </message>
        <message>
            <source>Residuals in the photographs</source>
            <translation>Residuals in the photographs</translation>
        </message>
        <message>
            <source>Residuals of the last adjustment, enlarged</source>
            <translation>Residuals of the last adjustment, enlarged</translation>
        </message>
        <message>
            <source>Restore defaults</source>
            <translation>Restore defaults</translation>
        </message>
        <message>
            <source>Result</source>
            <translation>Result</translation>
        </message>
        <message>
            <source>Round outer faces of solids are taken for pipes; to a surface only the shortest distance is measured</source>
            <translation>Round outer faces of solids are taken for pipes; to a surface only the shortest distance is measured</translation>
        </message>
        <message>
            <source>Round up to what can be bought</source>
            <translation>Round up to what can be bought</translation>
        </message>
        <message>
            <source>Runs that are nearly so are taken to be so, with little weight: the photographs decide where they say something else</source>
            <translation>Runs that are nearly so are taken to be so, with little weight: the photographs decide where they say something else</translation>
        </message>
        <message>
            <source>STEP solids</source>
            <translation>STEP solids</translation>
        </message>
        <message>
            <source>Same place</source>
            <translation>Same place</translation>
        </message>
        <message>
            <source>Save as CSV ...</source>
            <translation>Save as CSV ...</translation>
        </message>
        <message>
            <source>Save deviations</source>
            <translation>Save deviations</translation>
        </message>
        <message>
            <source>Score</source>
            <translation>Score</translation>
        </message>
        <message>
            <source>Search band</source>
            <translation>Search band</translation>
        </message>
        <message>
            <source>Second layer</source>
            <translation>Second layer</translation>
        </message>
        <message>
            <source>Select the solids in the tree or in 3D.</source>
            <translation>Select the solids in the tree or in 3D.</translation>
        </message>
        <message>
            <source>Selected components only</source>
            <translation>Selected components only</translation>
        </message>
        <message>
            <source>Set everything on this page to what it was at first</source>
            <translation>Set everything on this page to what it was at first</translation>
        </message>
        <message>
            <source>Set-on branch</source>
            <translation>Set-on branch</translation>
        </message>
        <message>
            <source>Sheet</source>
            <translation>Sheet</translation>
        </message>
        <message>
            <source>Sheet metal around the insulation</source>
            <translation>Sheet metal around the insulation</translation>
        </message>
        <message>
            <source>Shift mm</source>
            <translation>Shift mm</translation>
        </message>
        <message>
            <source>Show one pixel of the photograph as one of the screen (Ctrl+1)</source>
            <translation>Show one pixel of the photograph as one of the screen (Ctrl+1)</translation>
        </message>
        <message>
            <source>Show the insulation in 3D; the document stays as it is</source>
            <translation>Show the insulation in 3D; the document stays as it is</translation>
        </message>
        <message>
            <source>Show the next pipe of the list (digits choose directly)</source>
            <translation>Show the next pipe of the list (digits choose directly)</translation>
        </message>
        <message>
            <source>Show the parts of the contours that are behind something as dashed lines</source>
            <translation>Show the parts of the contours that are behind something as dashed lines</translation>
        </message>
        <message>
            <source>Show the photographs as they are, stretched to the screen's range</source>
            <translation>Show the photographs as they are, stretched to the screen's range</translation>
        </message>
        <message>
            <source>Show the photographs whole (F)</source>
            <translation>Show the photographs whole (F)</translation>
        </message>
        <message>
            <source>Show the same part of the object in the middle of all photographs</source>
            <translation>Show the same part of the object in the middle of all photographs</translation>
        </message>
        <message>
            <source>Size</source>
            <translation>Size</translation>
        </message>
        <message>
            <source>Snap to edges within</source>
            <translation>Snap to edges within</translation>
        </message>
        <message>
            <source>Solids: {labels}</source>
            <translation>Solids: {labels}</translation>
        </message>
        <message>
            <source>Something else is still being computed; wait for its end or cancel it</source>
            <translation>Something else is still being computed; wait for its end or cancel it</translation>
        </message>
        <message>
            <source>Specification of insulation</source>
            <translation>Specification of insulation</translation>
        </message>
        <message>
            <source>Specification {name}: {rules} rules, {obstacles} obstacles</source>
            <translation>Specification {name}: {rules} rules, {obstacles} obstacles</translation>
        </message>
        <message>
            <source>Specification...</source>
            <translation>Specification...</translation>
        </message>
        <message>
            <source>Standard</source>
            <translation>Standard</translation>
        </message>
        <message>
            <source>Standard deviation of its position before and after</source>
            <translation>Standard deviation of its position before and after</translation>
        </message>
        <message>
            <source>Standard sizes</source>
            <translation>Standard sizes</translation>
        </message>
        <message>
            <source>Standardised size (Baarda); 3.3 and more is a gross error</source>
            <translation>Standardised size (Baarda); 3.3 and more is a gross error</translation>
        </message>
        <message>
            <source>Station</source>
            <translation>Station</translation>
        </message>
        <message>
            <source>Station {name}: {count} components reconstructed</source>
            <translation>Station {name}: {count} components reconstructed</translation>
        </message>
        <message>
            <source>Station {name}: {count} photographs imported</source>
            <translation>Station {name}: {count} photographs imported</translation>
        </message>
        <message>
            <source>Station {station}: place ± {sigma:.2f} mm, heading ± {heading:.3f}°</source>
            <translation>Station {station}: place ± {sigma:.2f} mm, heading ± {heading:.3f}°</translation>
        </message>
        <message>
            <source>Stations</source>
            <translation>Stations</translation>
        </message>
        <message>
            <source>Stay joined to what stays</source>
            <translation>Stay joined to what stays</translation>
        </message>
        <message>
            <source>Straight edges found in the photographs</source>
            <translation>Straight edges found in the photographs</translation>
        </message>
        <message>
            <source>Straight lines</source>
            <translation>Straight lines</translation>
        </message>
        <message>
            <source>Surface of selected solids</source>
            <translation>Surface of selected solids</translation>
        </message>
        <message>
            <source>Surroundings</source>
            <translation>Surroundings</translation>
        </message>
        <message>
            <source>Table</source>
            <translation>Table</translation>
        </message>
        <message>
            <source>Tables of your own</source>
            <translation>Tables of your own</translation>
        </message>
        <message>
            <source>Take back what was assigned by hand</source>
            <translation>Take back what was assigned by hand</translation>
        </message>
        <message>
            <source>Take the chosen folder from the list; its files stay</source>
            <translation>Take the chosen folder from the list; its files stay</translation>
        </message>
        <message>
            <source>Take the chosen one off the list</source>
            <translation>Take the chosen one off the list</translation>
        </message>
        <message>
            <source>Take-off list</source>
            <translation>Take-off list</translation>
        </message>
        <message>
            <source>Tee</source>
            <translation>Tee</translation>
        </message>
        <message>
            <source>Tees, Reducers and Caps</source>
            <translation>Tees, Reducers and Caps</translation>
        </message>
        <message>
            <source>Temperature of the air around</source>
            <translation>Temperature of the air around</translation>
        </message>
        <message>
            <source>Temperature of what flows</source>
            <translation>Temperature of what flows</translation>
        </message>
        <message>
            <source>That is all. The document's other tab shows the pipeline in 3D; the keys V and F, one after the other, fit the view. Import photographs of your own with Import Station.</source>
            <translation>That is all. The document's other tab shows the pipeline in 3D; the keys V and F, one after the other, fit the view. Import photographs of your own with Import Station.</translation>
        </message>
        <message>
            <source>That is beside the photograph: click inside it</source>
            <translation>That is beside the photograph: click inside it</translation>
        </message>
        <message>
            <source>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous. Press Adjust in the panel, look at what it would change, and take it with OK.</source>
            <translation>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous. Press Adjust in the panel, look at what it would change, and take it with OK.</translation>
        </message>
        <message>
            <source>The components have changed: adjust them again.</source>
            <translation>The components have changed: adjust them again.</translation>
        </message>
        <message>
            <source>The components have changed: compare them again.</source>
            <translation>The components have changed: compare them again.</translation>
        </message>
        <message>
            <source>The components have changed: put the stations together again.</source>
            <translation>The components have changed: put the stations together again.</translation>
        </message>
        <message>
            <source>The distance in standard deviations; 4 and more does not fit</source>
            <translation>The distance in standard deviations; 4 and more does not fit</translation>
        </message>
        <message>
            <source>The flange facing it, too</source>
            <translation>The flange facing it, too</translation>
        </message>
        <message>
            <source>The model as designed</source>
            <translation>The model as designed</translation>
        </message>
        <message>
            <source>The next thickness that merchants keep in stock</source>
            <translation>The next thickness that merchants keep in stock</translation>
        </message>
        <message>
            <source>The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to move the photographs.</source>
            <translation>The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to move the photographs.</translation>
        </message>
        <message>
            <source>The photographs are not shown: {packages} is missing</source>
            <translation>The photographs are not shown: {packages} is missing</translation>
        </message>
        <message>
            <source>The pipes that the clicks can mean, the likeliest first: outside diameter, distance, and the quality, which is the mean distance of the image's edges from the contours</source>
            <translation>The pipes that the clicks can mean, the likeliest first: outside diameter, distance, and the quality, which is the mean distance of the image's edges from the contours</translation>
        </message>
        <message>
            <source>The preferences are not changed. {error}</source>
            <translation>The preferences are not changed. {error}</translation>
        </message>
        <message>
            <source>The report's heading, such as the project's name</source>
            <translation>The report's heading, such as the project's name</translation>
        </message>
        <message>
            <source>The station fits at several places: look at each in the 3D view and choose</source>
            <translation>The station fits at several places: look at each in the 3D view and choose</translation>
        </message>
        <message>
            <source>The station that stays where it is</source>
            <translation>The station that stays where it is</translation>
        </message>
        <message>
            <source>The table for a spreadsheet</source>
            <translation>The table for a spreadsheet</translation>
        </message>
        <message>
            <source>There is no flange to accept yet.</source>
            <translation>There is no flange to accept yet.</translation>
        </message>
        <message>
            <source>There is no pipe to accept yet.</source>
            <translation>There is no pipe to accept yet.</translation>
        </message>
        <message>
            <source>They make most of the file's size</source>
            <translation>They make most of the file's size</translation>
        </message>
        <message>
            <source>Thicker pipes are not looked for</source>
            <translation>Thicker pipes are not looked for</translation>
        </message>
        <message>
            <source>Thickness</source>
            <translation>Thickness</translation>
        </message>
        <message>
            <source>Thickness of the second layer</source>
            <translation>Thickness of the second layer</translation>
        </message>
        <message>
            <source>Thickness of the sheet metal</source>
            <translation>Thickness of the sheet metal</translation>
        </message>
        <message>
            <source>Thinner pipes are not looked for</source>
            <translation>Thinner pipes are not looked for</translation>
        </message>
        <message>
            <source>Threads</source>
            <translation>Threads</translation>
        </message>
        <message>
            <source>Tick the pipes from this confidence on: how much likelier they are than chance, as a logarithm</source>
            <translation>Tick the pipes from this confidence on: how much likelier they are than chance, as a logarithm</translation>
        </message>
        <message>
            <source>Tight bends</source>
            <translation>Tight bends</translation>
        </message>
        <message>
            <source>To check by eye: the photographs with what was measured drawn on them</source>
            <translation>To check by eye: the photographs with what was measured drawn on them</translation>
        </message>
        <message>
            <source>To look at and print: the sheets with their parts</source>
            <translation>To look at and print: the sheets with their parts</translation>
        </message>
        <message>
            <source>Tolerances</source>
            <translation>Tolerances</translation>
        </message>
        <message>
            <source>Too close</source>
            <translation>Too close</translation>
        </message>
        <message>
            <source>Turn °</source>
            <translation>Turn °</translation>
        </message>
        <message>
            <source>Type</source>
            <translation>Type</translation>
        </message>
        <message>
            <source>Types and pressure classes, the likeliest first; the score is the logarithm of how likely the images make them, those without one were not compared with the images</source>
            <translation>Types and pressure classes, the likeliest first; the score is the logarithm of how likely the images make them, those without one were not compared with the images</translation>
        </message>
        <message>
            <source>Up</source>
            <translation>Up</translation>
        </message>
        <message>
            <source>Use</source>
            <translation>Use</translation>
        </message>
        <message>
            <source>Version</source>
            <translation>Version</translation>
        </message>
        <message>
            <source>Warnings</source>
            <translation>Warnings</translation>
        </message>
        <message>
            <source>What a click in a photograph means</source>
            <translation>What a click in a photograph means</translation>
        </message>
        <message>
            <source>What and how</source>
            <translation>What and how</translation>
        </message>
        <message>
            <source>What and where to</source>
            <translation>What and where to</translation>
        </message>
        <message>
            <source>What does not fit</source>
            <translation>What does not fit</translation>
        </message>
        <message>
            <source>What is closer to the finished surface is listed as a clash</source>
            <translation>What is closer to the finished surface is listed as a clash</translation>
        </message>
        <message>
            <source>What is done where the insulation is too thick for a bend's radius</source>
            <translation>What is done where the insulation is too thick for a bend's radius</translation>
        </message>
        <message>
            <source>What is looked for</source>
            <translation>What is looked for</translation>
        </message>
        <message>
            <source>What it sets free; a dash where the share of a kWh is not known</source>
            <translation>What it sets free; a dash where the share of a kWh is not known</translation>
        </message>
        <message>
            <source>What that energy costs; a dash where its price is not known</source>
            <translation>What that energy costs; a dash where its price is not known</translation>
        </message>
        <message>
            <source>What the colours of the contours tell</source>
            <translation>What the colours of the contours tell</translation>
        </message>
        <message>
            <source>What the first and the last piece reach over the pipe</source>
            <translation>What the first and the last piece reach over the pipe</translation>
        </message>
        <message>
            <source>What they share</source>
            <translation>What they share</translation>
        </message>
        <message>
            <source>What was found; ticked ones are accepted together</source>
            <translation>What was found; ticked ones are accepted together</translation>
        </message>
        <message>
            <source>Where the model has other coordinates than the document; else both are compared as they stand</source>
            <translation>Where the model has other coordinates than the document; else both are compared as they stand</translation>
        </message>
        <message>
            <source>Where the point under the pointer lies in the other photographs, from near to far</source>
            <translation>Where the point under the pointer lies in the other photographs, from near to far</translation>
        </message>
        <message>
            <source>Where the search does not find it: say that the two selected components, one of each station, are the same</source>
            <translation>Where the search does not find it: say that the two selected components, one of each station, are the same</translation>
        </message>
        <message>
            <source>Whether it still counts</source>
            <translation>Whether it still counts</translation>
        </message>
        <message>
            <source>Which diameters are possible: those of the standard, any, or a certain one</source>
            <translation>Which diameters are possible: those of the standard, any, or a certain one</translation>
        </message>
        <message>
            <source>While in operation</source>
            <translation>While in operation</translation>
        </message>
        <message>
            <source>Wind</source>
            <translation>Wind</translation>
        </message>
        <message>
            <source>With a bend radius of {radius:g} mm nothing would be left of a pipe beside it.</source>
            <translation>With a bend radius of {radius:g} mm nothing would be left of a pipe beside it.</translation>
        </message>
        <message>
            <source>With insulation</source>
            <translation>With insulation</translation>
        </message>
        <message>
            <source>Within the standard's tolerances</source>
            <translation>Within the standard's tolerances</translation>
        </message>
        <message>
            <source>Without it</source>
            <translation>Without it</translation>
        </message>
        <message>
            <source>Write the flat parts of the jacket, laid out on sheets</source>
            <translation>Write the flat parts of the jacket, laid out on sheets</translation>
        </message>
        <message>
            <source>Write the list of parts, sheets and material</source>
            <translation>Write the list of parts, sheets and material</translation>
        </message>
        <message>
            <source>Write the pipeline as IFC for BIM, as STEP solids or as a table.</source>
            <translation>Write the pipeline as IFC for BIM, as STEP solids or as a table.</translation>
        </message>
        <message>
            <source>Written: {path}</source>
            <translation>Written: {path}</translation>
        </message>
        <message>
            <source>all</source>
            <translation>all</translation>
        </message>
        <message>
            <source>all ({count})</source>
            <translation>all ({count})</translation>
        </message>
        <message>
            <source>all components ({count})</source>
            <translation>all components ({count})</translation>
        </message>
        <message>
            <source>always an edge</source>
            <translation>always an edge</translation>
        </message>
        <message>
            <source>always the inside</source>
            <translation>always the inside</translation>
        </message>
        <message>
            <source>an edge where one is marked, else the inside</source>
            <translation>an edge where one is marked, else the inside</translation>
        </message>
        <message>
            <source>another task is open in the task panel</source>
            <translation>another task is open in the task panel</translation>
        </message>
        <message>
            <source>any (free)</source>
            <translation>any (free)</translation>
        </message>
        <message>
            <source>as entered below</source>
            <translation>as entered below</translation>
        </message>
        <message>
            <source>as it is ({count})</source>
            <translation>as it is ({count})</translation>
        </message>
        <message>
            <source>as long as the others</source>
            <translation>as long as the others</translation>
        </message>
        <message>
            <source>as the specification says</source>
            <translation>as the specification says</translation>
        </message>
        <message>
            <source>bare</source>
            <translation>bare</translation>
        </message>
        <message>
            <source>beyond</source>
            <translation>beyond</translation>
        </message>
        <message>
            <source>blind</source>
            <translation>blind</translation>
        </message>
        <message>
            <source>boxes</source>
            <translation>boxes</translation>
        </message>
        <message>
            <source>by DIN 4140</source>
            <translation>by DIN 4140</translation>
        </message>
        <message>
            <source>by heat loss</source>
            <translation>by heat loss</translation>
        </message>
        <message>
            <source>by kind</source>
            <translation>by kind</translation>
        </message>
        <message>
            <source>by quality</source>
            <translation>by quality</translation>
        </message>
        <message>
            <source>by rule</source>
            <translation>by rule</translation>
        </message>
        <message>
            <source>by surface temperature</source>
            <translation>by surface temperature</translation>
        </message>
        <message>
            <source>choose the model as designed</source>
            <translation>choose the model as designed</translation>
        </message>
        <message>
            <source>closed, for what it worked on was deleted</source>
            <translation>closed, for what it worked on was deleted</translation>
        </message>
        <message>
            <source>comparing with the model</source>
            <translation>comparing with the model</translation>
        </message>
        <message>
            <source>converged</source>
            <translation>converged</translation>
        </message>
        <message>
            <source>counts</source>
            <translation>counts</translation>
        </message>
        <message>
            <source>designed {designed:.1f} mm, difference {difference:+.1f} mm</source>
            <translation>designed {designed:.1f} mm, difference {difference:+.1f} mm</translation>
        </message>
        <message>
            <source>did not converge</source>
            <translation>did not converge</translation>
        </message>
        <message>
            <source>does not fit</source>
            <translation>does not fit</translation>
        </message>
        <message>
            <source>exact</source>
            <translation>exact</translation>
        </message>
        <message>
            <source>finding edges</source>
            <translation>finding edges</translation>
        </message>
        <message>
            <source>finding edges...</source>
            <translation>finding edges...</translation>
        </message>
        <message>
            <source>finish it first</source>
            <translation>finish it first</translation>
        </message>
        <message>
            <source>finish or close it first</source>
            <translation>finish or close it first</translation>
        </message>
        <message>
            <source>fixed</source>
            <translation>fixed</translation>
        </message>
        <message>
            <source>follows from its pipes</source>
            <translation>follows from its pipes</translation>
        </message>
        <message>
            <source>free</source>
            <translation>free</translation>
        </message>
        <message>
            <source>give at least one layer</source>
            <translation>give at least one layer</translation>
        </message>
        <message>
            <source>give one</source>
            <translation>give one</translation>
        </message>
        <message>
            <source>grey {value}</source>
            <translation>grey {value}</translation>
        </message>
        <message>
            <source>half as long as the others</source>
            <translation>half as long as the others</translation>
        </message>
        <message>
            <source>is</source>
            <translation>is</translation>
        </message>
        <message>
            <source>its document was closed</source>
            <translation>its document was closed</translation>
        </message>
        <message>
            <source>its photographs are missing</source>
            <translation>its photographs are missing</translation>
        </message>
        <message>
            <source>kWh/a</source>
            <translation>kWh/a</translation>
        </message>
        <message>
            <source>last seen in {folder}</source>
            <translation>last seen in {folder}</translation>
        </message>
        <message>
            <source>left out</source>
            <translation>left out</translation>
        </message>
        <message>
            <source>longer than the half</source>
            <translation>longer than the half</translation>
        </message>
        <message>
            <source>loose plate</source>
            <translation>loose plate</translation>
        </message>
        <message>
            <source>loose plate, neck</source>
            <translation>loose plate, neck</translation>
        </message>
        <message>
            <source>model.ifc</source>
            <translation>model.ifc</translation>
        </message>
        <message>
            <source>no component is selected</source>
            <translation>no component is selected</translation>
        </message>
        <message>
            <source>no solid is selected</source>
            <translation>no solid is selected</translation>
        </message>
        <message>
            <source>none</source>
            <translation>none</translation>
        </message>
        <message>
            <source>not determined</source>
            <translation>not determined</translation>
        </message>
        <message>
            <source>not known</source>
            <translation>not known</translation>
        </message>
        <message>
            <source>not trusted</source>
            <translation>not trusted</translation>
        </message>
        <message>
            <source>not two components of two stations are selected</source>
            <translation>not two components of two stations are selected</translation>
        </message>
        <message>
            <source>nothing is insulated like this</source>
            <translation>nothing is insulated like this</translation>
        </message>
        <message>
            <source>nothing was put together yet</source>
            <translation>nothing was put together yet</translation>
        </message>
        <message>
            <source>now</source>
            <translation>now</translation>
        </message>
        <message>
            <source>of the standard</source>
            <translation>of the standard</translation>
        </message>
        <message>
            <source>open it again</source>
            <translation>open it again</translation>
        </message>
        <message>
            <source>open one, or import a station first</source>
            <translation>open one, or import a station first</translation>
        </message>
        <message>
            <source>planning the insulation</source>
            <translation>planning the insulation</translation>
        </message>
        <message>
            <source>plate</source>
            <translation>plate</translation>
        </message>
        <message>
            <source>press Adjust first</source>
            <translation>press Adjust first</translation>
        </message>
        <message>
            <source>press Find What They Share first</source>
            <translation>press Find What They Share first</translation>
        </message>
        <message>
            <source>px in photographs, mm or degrees of conditions</source>
            <translation>px in photographs, mm or degrees of conditions</translation>
        </message>
        <message>
            <source>q px</source>
            <translation>q px</translation>
        </message>
        <message>
            <source>reading...</source>
            <translation>reading...</translation>
        </message>
        <message>
            <source>refuse</source>
            <translation>refuse</translation>
        </message>
        <message>
            <source>runs of the selected ({count})</source>
            <translation>runs of the selected ({count})</translation>
        </message>
        <message>
            <source>saved</source>
            <translation>saved</translation>
        </message>
        <message>
            <source>say where they are in its photo window</source>
            <translation>say where they are in its photo window</translation>
        </message>
        <message>
            <source>segmented</source>
            <translation>segmented</translation>
        </message>
        <message>
            <source>select one of each (Ctrl and click)</source>
            <translation>select one of each (Ctrl and click)</translation>
        </message>
        <message>
            <source>select some, or adjust all</source>
            <translation>select some, or adjust all</translation>
        </message>
        <message>
            <source>select some, or compare all</source>
            <translation>select some, or compare all</translation>
        </message>
        <message>
            <source>select some, or export all</source>
            <translation>select some, or export all</translation>
        </message>
        <message>
            <source>select some, or insulate all</source>
            <translation>select some, or insulate all</translation>
        </message>
        <message>
            <source>select the solids as designed in the tree or in 3D</source>
            <translation>select the solids as designed in the tree or in 3D</translation>
        </message>
        <message>
            <source>selected ({count})</source>
            <translation>selected ({count})</translation>
        </message>
        <message>
            <source>selected components ({count})</source>
            <translation>selected components ({count})</translation>
        </message>
        <message>
            <source>slip-on</source>
            <translation>slip-on</translation>
        </message>
        <message>
            <source>smooth</source>
            <translation>smooth</translation>
        </message>
        <message>
            <source>there is no IFC file</source>
            <translation>there is no IFC file</translation>
        </message>
        <message>
            <source>there is no document</source>
            <translation>there is no document</translation>
        </message>
        <message>
            <source>there is no file name</source>
            <translation>there is no file name</translation>
        </message>
        <message>
            <source>there is no result yet</source>
            <translation>there is no result yet</translation>
        </message>
        <message>
            <source>threaded</source>
            <translation>threaded</translation>
        </message>
        <message>
            <source>to</source>
            <translation>to</translation>
        </message>
        <message>
            <source>two pieces with a mitre</source>
            <translation>two pieces with a mitre</translation>
        </message>
        <message>
            <source>up to</source>
            <translation>up to</translation>
        </message>
        <message>
            <source>w</source>
            <translation>w</translation>
        </message>
        <message>
            <source>weak</source>
            <translation>weak</translation>
        </message>
        <message>
            <source>weld neck</source>
            <translation>weld neck</translation>
        </message>
        <message>
            <source>with this insulation</source>
            <translation>with this insulation</translation>
        </message>
        <message>
            <source>within their tolerances</source>
            <translation>within their tolerances</translation>
        </message>
        <message>
            <source>writing {path}</source>
            <translation>writing {path}</translation>
        </message>
        <message>
            <source>written: {path}</source>
            <translation>written: {path}</translation>
        </message>
        <message>
            <source>{component} is weakly placed (σ {sigma:.1f} mm): {reason}</source>
            <translation>{component} is weakly placed (σ {sigma:.1f} mm): {reason}</translation>
        </message>
        <message>
            <source>{count} beyond</source>
            <translation>{count} beyond</translation>
        </message>
        <message>
            <source>{count} components insulated</source>
            <translation>{count} components insulated</translation>
        </message>
        <message>
            <source>{count} found. Click on one to choose it.</source>
            <translation>{count} found. Click on one to choose it.</translation>
        </message>
        <message>
            <source>{count} up to {limit:g} mm</source>
            <translation>{count} up to {limit:g} mm</translation>
        </message>
        <message>
            <source>{count} within {limit:g} mm</source>
            <translation>{count} within {limit:g} mm</translation>
        </message>
        <message>
            <source>{count} without counterpart</source>
            <translation>{count} without counterpart</translation>
        </message>
        <message>
            <source>{diameter:g} mm, as entered</source>
            <translation>{diameter:g} mm, as entered</translation>
        </message>
        <message>
            <source>{pieces} pieces over {length:.1f} m: {volume:.3f} m³ of insulation, {area:.2f} m² of jacket</source>
            <translation>{pieces} pieces over {length:.1f} m: {volume:.3f} m³ of insulation, {area:.2f} m² of jacket</translation>
        </message>
        <message>
            <source>{station} ({count} components)</source>
            <translation>{station} ({count} components)</translation>
        </message>
        <message>
            <source>{station} - photographs</source>
            <translation>{station} - photographs</translation>
        </message>
        <message>
            <source>{station} in {reference}, place {place}: {count} components fit (score {score:.1f})</source>
            <translation>{station} in {reference}, place {place}: {count} components fit (score {score:.1f})</translation>
        </message>
        <message>
            <source>{station}: these photographs are not where they were</source>
            <translation>{station}: these photographs are not where they were</translation>
        </message>
        <message>
            <source>{what} failed ({error}); the report view has the details, please report them</source>
            <translation>{what} failed ({error}); the report view has the details, please report them</translation>
        </message>
        <message>
            <source>{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}</source>
            <translation>{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}</translation>
        </message>
        <message>
            <source>{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again</source>
            <translation>{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again</translation>
        </message>
        <message>
            <source>{what}: cancelled</source>
            <translation>{what}: cancelled</translation>
        </message>
        <message>
            <source>Δx mm</source>
            <translation>Δx mm</translation>
        </message>
        <message>
            <source>Δy mm</source>
            <translation>Δy mm</translation>
        </message>
        <message>
            <source>Δz mm</source>
            <translation>Δz mm</translation>
        </message>
        <message>
            <source>σ</source>
            <translation>σ</translation>
        </message>
        <message>
            <source>σ mm</source>
            <translation>σ mm</translation>
        </message>
    </context>
    <context>
        <name>Workbench</name>
        <message>
            <source>Pipe Workbench help</source>
            <translation>Pipe Workbench help</translation>
        </message>
        <message>
            <source>Pipe adjustment</source>
            <translation>Pipe adjustment</translation>
        </message>
        <message>
            <source>Pipe measuring</source>
            <translation>Pipe measuring</translation>
        </message>
        <message>
            <source>Pipe output</source>
            <translation>Pipe output</translation>
        </message>
    </context>
</TS>
