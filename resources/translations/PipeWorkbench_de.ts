<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de" sourcelanguage="en">
    <context>
        <name>App::Property</name>
        <message>
            <source>A fitting (tee) or a branch welded on (set-on)</source>
            <translation>Ein Formstück (tee) oder ein aufgeschweißter Abzweig (set-on)</translation>
        </message>
        <message>
            <source>Added to the bolts' length between flange and insulation, so that bolts can be pulled</source>
            <translation>Zugabe zur Länge der Schrauben zwischen Flansch und Dämmung, damit sie gezogen werden können</translation>
        </message>
        <message>
            <source>Bends of straight pieces (segmented) or round ones, as of foam shells (smooth)</source>
            <translation>Bögen aus geraden Segmenten (segmented) oder runde, wie aus Schaumschalen (smooth)</translation>
        </message>
        <message>
            <source>Bends that are too tight for the thickness: two pieces with a mitre, or refuse</source>
            <translation>Bögen, die für die Dicke zu eng sind: zwei Stücke auf Gehrung (mitre) oder ablehnen (refuse)</translation>
        </message>
        <message>
            <source>Between a flange's rim and the inside of its box</source>
            <translation>Zwischen dem Rand eines Flansches und dem Inneren seiner Kappe</translation>
        </message>
        <message>
            <source>Between the run's direction and the branch</source>
            <translation>Zwischen der Richtung des Durchgangs und dem Abzweig</translation>
        </message>
        <message>
            <source>Boxes of two half shells over flanges, or bare flanges</source>
            <translation>Kappen aus zwei Halbschalen über Flanschen (box) oder freie Flansche (bare)</translation>
        </message>
        <message>
            <source>By what the first and the last piece are longer than the half</source>
            <translation>Um wie viel das erste und das letzte Segment länger sind als die Hälfte</translation>
        </message>
        <message>
            <source>CO2 of a kWh of energy in kg, 0: not known</source>
            <translation>CO2 einer kWh Energie in kg, 0: nicht bekannt</translation>
        </message>
        <message>
            <source>Change of direction</source>
            <translation>Richtungsänderung</translation>
        </message>
        <message>
            <source>Class that FreeCAD's own BIM exporter gives it</source>
            <translation>Klasse, die FreeCADs eigener BIM-Export ihm gibt</translation>
        </message>
        <message>
            <source>Coverings: straight ones, bends, boxes, ...</source>
            <translation>Umhüllungen: gerade Stücke, Bögen, Kappen, ...</translation>
        </message>
        <message>
            <source>Diameter D of the plate</source>
            <translation>Durchmesser D des Blatts</translation>
        </message>
        <message>
            <source>Diameter K of the bolt circle; 0 where it is not known</source>
            <translation>Lochkreisdurchmesser K; 0, wenn er nicht bekannt ist</translation>
        </message>
        <message>
            <source>Diameter L of a bolt hole; 0 where it is not known</source>
            <translation>Durchmesser L eines Schraubenlochs; 0, wenn er nicht bekannt ist</translation>
        </message>
        <message>
            <source>Diameter of the neck where it leaves the plate; 0 for the pipe's</source>
            <translation>Durchmesser des Ansatzes am Blatt; 0 für den des Rohrs</translation>
        </message>
        <message>
            <source>Diameter of the raised face; 0 where it is not known</source>
            <translation>Durchmesser der Dichtleiste; 0, wenn er nicht bekannt ist</translation>
        </message>
        <message>
            <source>Diameter of the rivet holes</source>
            <translation>Durchmesser der Nietlöcher</translation>
        </message>
        <message>
            <source>Digest of what the shape was made from</source>
            <translation>Prüfsumme dessen, woraus die Form entstanden ist</translation>
        </message>
        <message>
            <source>Digests of the shape's parts</source>
            <translation>Prüfsummen der Teile der Form</translation>
        </message>
        <message>
            <source>Distance of the rivet holes along seams, 0 for none</source>
            <translation>Abstand der Nietlöcher entlang der Nähte, 0 für keine</translation>
        </message>
        <message>
            <source>Draw the bolts, through a partner of the same thickness</source>
            <translation>Die Schrauben zeichnen, durch einen gleich dicken Gegenflansch</translation>
        </message>
        <message>
            <source>Files of the photographs</source>
            <translation type="vanished">Dateien der Fotos</translation>
        </message>
        <message>
            <source>Files of the photographs, relative to the document</source>
            <translation>Dateien der Fotos, relativ zum Dokument</translation>
        </message>
        <message>
            <source>First and last piece of a bend: half as long as the others, equal, or longer than the half</source>
            <translation>Erstes und letztes Segment eines Bogens: halb so lang wie die anderen (half), gleich lang (equal) oder länger als die Hälfte (longer)</translation>
        </message>
        <message>
            <source>Flanges of the same dimensions, which images cannot tell apart</source>
            <translation>Flansche mit denselben Maßen, die sich in Bildern nicht unterscheiden lassen</translation>
        </message>
        <message>
            <source>From the branch's axis to the end of the run</source>
            <translation>Von der Abzweigachse bis zum Ende des Durchgangs</translation>
        </message>
        <message>
            <source>From the branch's axis to the start of the run</source>
            <translation>Von der Abzweigachse bis zum Anfang des Durchgangs</translation>
        </message>
        <message>
            <source>From the face to the weld end</source>
            <translation>Von der Dichtfläche bis zum Schweißende</translation>
        </message>
        <message>
            <source>From the run's axis to the end of the branch</source>
            <translation>Von der Durchgangsachse bis zum Ende des Abzweigs</translation>
        </message>
        <message>
            <source>From the weld end to the top</source>
            <translation>Vom Schweißende bis zum Scheitel</translation>
        </message>
        <message>
            <source>Heat delivered over energy bought</source>
            <translation>Gelieferte Wärme je eingekaufter Energie</translation>
        </message>
        <message>
            <source>Heat loss in W with the insulation, bare components included</source>
            <translation>Wärmeverlust in W mit der Dämmung, ungedämmte Bauteile eingeschlossen</translation>
        </message>
        <message>
            <source>Heat loss in W without insulation; 0 where the medium's temperature is not known</source>
            <translation>Wärmeverlust in W ohne Dämmung; 0, wenn die Temperatur des Mediums nicht bekannt ist</translation>
        </message>
        <message>
            <source>Height of the raised face</source>
            <translation>Höhe der Dichtleiste</translation>
        </message>
        <message>
            <source>Hours of operation in a year</source>
            <translation>Betriebsstunden im Jahr</translation>
        </message>
        <message>
            <source>How far a box reaches over the pipe's jacket</source>
            <translation>Wie weit eine Kappe über den Mantel des Rohrs reicht</translation>
        </message>
        <message>
            <source>How well the standard's dimensions are sourced</source>
            <translation>Wie gut die Maße der Norm belegt sind</translation>
        </message>
        <message>
            <source>Identity in exchange files</source>
            <translation>Kennung in Austauschdateien</translation>
        </message>
        <message>
            <source>Index of the pick that made the component, -1 for none</source>
            <translation>Nummer der Markierung, aus der das Bauteil entstand, -1 für keine</translation>
        </message>
        <message>
            <source>Keep the component as it is when its pick is reconstructed again</source>
            <translation type="vanished">Das Bauteil so lassen, wie es ist, wenn seine Markierung erneut rekonstruiert wird</translation>
        </message>
        <message>
            <source>Keep the component where and as it is, whatever is adjusted, measured again or joined to it</source>
            <translation>Das Bauteil an seinem Ort und wie es ist lassen, was auch ausgeglichen, neu gemessen oder angeschlossen wird</translation>
        </message>
        <message>
            <source>Keep the photographs inside the document, which makes its file larger</source>
            <translation>Die Fotos im Dokument behalten, was dessen Datei vergrößert</translation>
        </message>
        <message>
            <source>Layers around the second one, outwards, each like '40 mm mineral wool'</source>
            <translation>Lagen um die zweite, nach außen, jede wie '40 mm mineral wool'</translation>
        </message>
        <message>
            <source>Length along the axis</source>
            <translation>Länge entlang der Achse</translation>
        </message>
        <message>
            <source>Length of the neck's straight part at the weld end</source>
            <translation>Länge des zylindrischen Ansatzes am Schweißende</translation>
        </message>
        <message>
            <source>Level of accuracy (USIBD)</source>
            <translation>Genauigkeitsstufe (LOA nach USIBD)</translation>
        </message>
        <message>
            <source>Mark the beads along the round edges</source>
            <translation>Die Sicken entlang der runden Kanten anzeichnen</translation>
        </message>
        <message>
            <source>Name in exchange files</source>
            <translation>Name in Austauschdateien</translation>
        </message>
        <message>
            <source>Name of the project in reports and exchange files</source>
            <translation>Name des Projekts in Berichten und Austauschdateien</translation>
        </message>
        <message>
            <source>Names of the cameras</source>
            <translation>Namen der Kameras</translation>
        </message>
        <message>
            <source>Nominal diameter of the standard</source>
            <translation>Nennweite nach Norm</translation>
        </message>
        <message>
            <source>Number of bolts; 0 where it is not known</source>
            <translation>Anzahl der Schrauben; 0, wenn sie nicht bekannt ist</translation>
        </message>
        <message>
            <source>Numbers of the ends that are joined to the own ones</source>
            <translation>Nummern der Enden, die mit den eigenen verbunden sind</translation>
        </message>
        <message>
            <source>Of all layers, without the jacket</source>
            <translation>Aller Lagen, ohne den Blechmantel</translation>
        </message>
        <message>
            <source>Of the narrow end across the axis, where it is eccentric</source>
            <translation>Versatz des engen Endes quer zur Achse, wenn es exzentrisch ist</translation>
        </message>
        <message>
            <source>Outer surface of the jacket, without overlaps</source>
            <translation>Äußere Oberfläche des Blechmantels, ohne Überlappungen</translation>
        </message>
        <message>
            <source>Outside diameter</source>
            <translation>Außendurchmesser</translation>
        </message>
        <message>
            <source>Outside diameter of the branch</source>
            <translation>Außendurchmesser des Abzweigs</translation>
        </message>
        <message>
            <source>Outside diameter of the narrow end</source>
            <translation>Außendurchmesser des engen Endes</translation>
        </message>
        <message>
            <source>PN</source>
            <translation type="vanished">PN</translation>
        </message>
        <message>
            <source>Pieces of a segmented bend, 0: by the rule</source>
            <translation>Segmente eines Segmentbogens, 0: nach der Regel</translation>
        </message>
        <message>
            <source>Pipes and fittings that are insulated</source>
            <translation>Rohre und Formteile, die gedämmt werden</translation>
        </message>
        <message>
            <source>Pressure class as a number</source>
            <translation>Druckstufe als Zahl</translation>
        </message>
        <message>
            <source>Pressure class of the standards</source>
            <translation>Druckstufe der Normen</translation>
        </message>
        <message>
            <source>Price of a kWh of energy, 0: not known</source>
            <translation>Preis einer kWh Energie, 0: nicht bekannt</translation>
        </message>
        <message>
            <source>RMS distance to the image edges in pixels (Eq. 4)</source>
            <translation>Mittlerer quadratischer Abstand zu den Bildkanten in Pixeln (Gl. 4)</translation>
        </message>
        <message>
            <source>Radius of the bent axis</source>
            <translation>Radius der gebogenen Achse</translation>
        </message>
        <message>
            <source>Sheet metal around the insulation</source>
            <translation>Blech um die Dämmung</translation>
        </message>
        <message>
            <source>Speed of the wind, 0 indoors</source>
            <translation>Windgeschwindigkeit, 0 in Gebäuden</translation>
        </message>
        <message>
            <source>Standard deviation of the direction</source>
            <translation>Standardabweichung der Richtung</translation>
        </message>
        <message>
            <source>Standard deviation of the measured diameter</source>
            <translation>Standardabweichung des gemessenen Durchmessers</translation>
        </message>
        <message>
            <source>Standard deviation of the middle along x, y, z in mm</source>
            <translation>Standardabweichung der Mitte in x, y, z in mm</translation>
        </message>
        <message>
            <source>Standard deviation of unit weight of the adjustment, 0 for none</source>
            <translation>Standardabweichung der Gewichtseinheit der Ausgleichung, 0 für keine</translation>
        </message>
        <message>
            <source>Standard of the dimensions</source>
            <translation>Norm der Maße</translation>
        </message>
        <message>
            <source>Standard size within 3 sigma of a free diameter</source>
            <translation>Normgröße innerhalb von 3 Sigma eines freien Durchmessers</translation>
        </message>
        <message>
            <source>Starts and ends, in mm from the pipe's start, of what was bridged</source>
            <translation>Anfang und Ende der überbrückten Lücken, in mm vom Rohranfang</translation>
        </message>
        <message>
            <source>Station in whose level frame the components are</source>
            <translation>Standpunkt, in dessen waagerechtem System die Bauteile liegen</translation>
        </message>
        <message>
            <source>Station that measured the component</source>
            <translation>Standpunkt, von dem das Bauteil gemessen wurde</translation>
        </message>
        <message>
            <source>Stations that measured the components</source>
            <translation>Standpunkte, von denen die Bauteile gemessen wurden</translation>
        </message>
        <message>
            <source>Take the next thickness that can be bought where it follows from a rule</source>
            <translation>Die nächste lieferbare Dicke nehmen, wo sie sich aus einer Regel ergibt</translation>
        </message>
        <message>
            <source>Temperature of the medium in °C, -273.15: not known</source>
            <translation>Temperatur des Mediums in °C, -273,15: nicht bekannt</translation>
        </message>
        <message>
            <source>Temperature of the surroundings in °C</source>
            <translation>Temperatur der Umgebung in °C</translation>
        </message>
        <message>
            <source>The component that was measured, and how it was modelled (JSON)</source>
            <translation>Das gemessene Bauteil und wie es modelliert wurde (JSON)</translation>
        </message>
        <message>
            <source>The ends do not lie on one axis</source>
            <translation>Die Enden liegen nicht auf einer Achse</translation>
        </message>
        <message>
            <source>The georeference as exchange files have it (JSON)</source>
            <translation>Der Raumbezug, wie er in Austauschdateien steht (JSON)</translation>
        </message>
        <message>
            <source>The images do not support the pipe well</source>
            <translation>Die Bilder stützen das Rohr nicht gut</translation>
        </message>
        <message>
            <source>The pipeline without its components (JSON)</source>
            <translation type="vanished">Die Rohrleitung ohne ihre Bauteile (JSON)</translation>
        </message>
        <message>
            <source>The pipeline without its components (JSON); of its joints those hold that are linked</source>
            <translation>Die Rohrleitung ohne ihre Bauteile (JSON); von ihren Verbindungen gelten die verknüpften</translation>
        </message>
        <message>
            <source>The plant's coordinate system; empty where it is not known</source>
            <translation>Koordinatensystem der Anlage; leer, wenn es nicht bekannt ist</translation>
        </message>
        <message>
            <source>These flanges as exchange files have them (JSON)</source>
            <translation>Diese Flansche, wie sie in Austauschdateien stehen (JSON)</translation>
        </message>
        <message>
            <source>Thickness C of the plate, raised face included</source>
            <translation>Dicke C des Blatts einschließlich Dichtleiste</translation>
        </message>
        <message>
            <source>Thickness of the inner layer where the rule is 'fixed'</source>
            <translation>Dicke der inneren Lage, wenn die Regel 'fixed' (fest) ist</translation>
        </message>
        <message>
            <source>Thickness of the second layer, 0 for none</source>
            <translation>Dicke der zweiten Lage, 0 für keine</translation>
        </message>
        <message>
            <source>Thickness of the sheet metal, 0: by the finished diameter after DIN 4140</source>
            <translation>Dicke des Blechs, 0: nach dem fertigen Durchmesser gemäß DIN 4140</translation>
        </message>
        <message>
            <source>Type of EN 1092-1 (01 plate, 05 blind, 11 weld neck, ...)</source>
            <translation>Typ nach EN 1092-1 (01 glatt, 05 blind, 11 Vorschweiß, ...)</translation>
        </message>
        <message>
            <source>Type of the standard (2D, 3D, 5D)</source>
            <translation type="vanished">Bauart der Norm (2D, 3D, 5D)</translation>
        </message>
        <message>
            <source>Type of the standard; choosing one sets the bend radius</source>
            <translation>Bauart der Norm; ihre Wahl bestimmt den Biegeradius</translation>
        </message>
        <message>
            <source>Up to this distance two flange faces are taken for a valve's</source>
            <translation>Bis zu diesem Abstand gelten zwei Dichtflächen als die einer Armatur</translation>
        </message>
        <message>
            <source>Version of this object's properties</source>
            <translation>Version der Eigenschaften dieses Objekts</translation>
        </message>
        <message>
            <source>Wall thickness; 0 where it is not known</source>
            <translation>Wanddicke; 0, wenn sie nicht bekannt ist</translation>
        </message>
        <message>
            <source>What else is to be known</source>
            <translation>Was sonst zu wissen ist</translation>
        </message>
        <message>
            <source>What is added along the length seams</source>
            <translation>Zugabe an den Längsnähten</translation>
        </message>
        <message>
            <source>What is added between the pieces of a bend</source>
            <translation>Zugabe zwischen den Segmenten eines Bogens</translation>
        </message>
        <message>
            <source>What is added where a jacket goes over the next one</source>
            <translation>Zugabe, wo ein Mantel über den nächsten greift</translation>
        </message>
        <message>
            <source>What is closer to the finished surface is listed among the clashes</source>
            <translation>Was der fertigen Oberfläche näher ist, steht unter den Kollisionen</translation>
        </message>
        <message>
            <source>What is closer to the insulation than the minimum distance</source>
            <translation>Was der Dämmung näher ist als der Mindestabstand</translation>
        </message>
        <message>
            <source>What is joined to a component follows when the component is changed</source>
            <translation>Was mit einem Bauteil verbunden ist, folgt, wenn es geändert wird</translation>
        </message>
        <message>
            <source>What station.json holds</source>
            <translation>Was station.json enthält</translation>
        </message>
        <message>
            <source>What the colours of the components say</source>
            <translation>Was die Farben der Bauteile aussagen</translation>
        </message>
        <message>
            <source>What the inner layer is made of</source>
            <translation>Woraus die innere Lage besteht</translation>
        </message>
        <message>
            <source>What the length seams of neighbours are turned against each other</source>
            <translation>Um wie viel die Längsnähte von Nachbarn gegeneinander verdreht sind</translation>
        </message>
        <message>
            <source>What the properties do not say, as a specification file has it (JSON)</source>
            <translation>Was die Eigenschaften nicht sagen, wie in einer Spezifikationsdatei (JSON)</translation>
        </message>
        <message>
            <source>What the rule 'heat loss' allows in W/m, and the rule 'surface temperature' in °C</source>
            <translation>Was die Regel 'heat loss' (Wärmeverlust) in W/m und die Regel 'surface temperature' (Oberflächentemperatur) in °C zulässt</translation>
        </message>
        <message>
            <source>What the second layer is made of</source>
            <translation>Woraus die zweite Lage besteht</translation>
        </message>
        <message>
            <source>What the sheet shrinks by for each bead</source>
            <translation>Um wie viel das Blech je Sicke kürzer wird</translation>
        </message>
        <message>
            <source>What the thickness of the inner layer follows from</source>
            <translation>Woraus sich die Dicke der inneren Lage ergibt</translation>
        </message>
        <message>
            <source>Where station.json and the photographs were found last</source>
            <translation>Wo station.json und die Fotos zuletzt gefunden wurden</translation>
        </message>
        <message>
            <source>Where the first station's frame lies in the plant</source>
            <translation>Wo das System des ersten Standpunkts in der Anlage liegt</translation>
        </message>
        <message>
            <source>Where the station's level frame lies in the document's frame</source>
            <translation>Wo das waagerechte System des Standpunkts im Dokument liegt</translation>
        </message>
        <message>
            <source>Which ends are joined: component and number of its end</source>
            <translation type="vanished">Welche Enden verbunden sind: Bauteil und Nummer seines Endes</translation>
        </message>
        <message>
            <source>Why components stay bare</source>
            <translation>Warum Bauteile ungedämmt bleiben</translation>
        </message>
        <message>
            <source>station.json with the calibration of the cameras</source>
            <translation type="vanished">station.json mit der Kalibrierung der Kameras</translation>
        </message>
        <message>
            <source>station.json with the calibration, relative to the document</source>
            <translation>station.json mit der Kalibrierung, relativ zum Dokument</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Adjust</name>
        <message>
            <source>Adjust</source>
            <translation>Ausgleichen</translation>
        </message>
        <message>
            <source>Adjust pipes and fittings, all or those selected, to the edges of all photographs, with their joints and standard sizes</source>
            <translation>Rohre und Formstücke, alle oder die ausgewählten, mit ihren Verbindungen und Normgrößen an die Kanten aller Fotos anpassen</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Deviations</name>
        <message>
            <source>Deviations</source>
            <translation>Abweichungen</translation>
        </message>
        <message>
            <source>Measure how pipes and fittings deviate from a design: an IFC model, or solids of the document</source>
            <translation>Messen, wie Rohre und Formstücke von einer Planung abweichen: einem IFC-Modell oder Körpern des Dokuments</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Elbows</name>
        <message>
            <source>Elbows</source>
            <translation>Bögen</translation>
        </message>
        <message>
            <source>Find the elbows between the pipes, or between two selected pipes, and choose their bend radius</source>
            <translation>Die Bögen zwischen den Rohren oder zwischen zwei ausgewählten Rohren finden und ihren Biegeradius wählen</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ExampleProject</name>
        <message>
            <source>Example project: dummy station</source>
            <translation>Beispielprojekt: Attrappe</translation>
        </message>
        <message>
            <source>Open an example with photographs, and a guide through the first steps</source>
            <translation>Ein Beispiel mit Fotos öffnen, mit Anleitung durch die ersten Schritte</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Export</name>
        <message>
            <source>Export</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV or as a picture</source>
            <translation type="vanished">Rohre und Formstücke (alle oder die ausgewählten) als IFC, STEP, JSON, CSV oder als Bild exportieren</translation>
        </message>
        <message>
            <source>Export pipes and fittings (all, or those selected) as IFC, STEP, JSON, CSV, as a report or as a picture</source>
            <translation>Rohre und Formstücke (alle oder die ausgewählten) als IFC, STEP, JSON, CSV, als Bericht oder als Bild exportieren</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_FindPipes</name>
        <message>
            <source>Find Pipes</source>
            <translation>Rohre finden</translation>
        </message>
        <message>
            <source>Look for pipes in the whole station without any click; each is proposed and accepted or rejected</source>
            <translation>Im ganzen Standpunkt ohne Klick nach Rohren suchen; jedes wird vorgeschlagen und angenommen oder abgelehnt</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Fittings</name>
        <message>
            <source>Find tees, reducers and caps at the pipes, or at the selected pipes</source>
            <translation>T-Stücke, Reduzierstücke und Kappen an den Rohren oder an den ausgewählten Rohren finden</translation>
        </message>
        <message>
            <source>Tees, Reducers and Caps</source>
            <translation>T-Stücke, Reduzierstücke und Kappen</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Flange</name>
        <message>
            <source>Flange</source>
            <translation>Flansch</translation>
        </message>
        <message>
            <source>Measure a flange: click on the straight edge of its rim; or give the selected flange another type</source>
            <translation>Einen Flansch messen: auf die gerade Kante seines Rands klicken; oder dem ausgewählten Flansch einen anderen Typ geben</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ImportStation</name>
        <message>
            <source>Import Station</source>
            <translation>Standpunkt importieren</translation>
        </message>
        <message>
            <source>Import the photographs and the calibration of a station (station.json)</source>
            <translation>Fotos und Kalibrierung eines Standpunkts importieren (station.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Insulation</name>
        <message>
            <source>Insulate pipes and fittings (all, or those selected): layers, jacket, boxes over flanges, heat saved, sheets to cut</source>
            <translation>Rohre und Formteile dämmen (alle oder die ausgewählten): Lagen, Blechmantel, Kappen über Flanschen, gesparte Wärme, Zuschnitte</translation>
        </message>
        <message>
            <source>Insulation</source>
            <translation>Dämmung</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_MergeStations</name>
        <message>
            <source>Merge Stations</source>
            <translation>Standpunkte zusammenführen</translation>
        </message>
        <message>
            <source>Put several stations together over the pipes and fittings they share, and adjust them over all photographs</source>
            <translation>Mehrere Standpunkte über gemeinsame Rohre und Formstücke zusammenführen und über alle Fotos ausgleichen</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_PhotoWindow</name>
        <message>
            <source>Photo Window</source>
            <translation>Fotofenster</translation>
        </message>
        <message>
            <source>Show the photographs of a station side by side, to measure in them</source>
            <translation type="vanished">Die Fotos eines Standpunkts nebeneinander zeigen, um darin zu messen</translation>
        </message>
        <message>
            <source>Show the station's photographs side by side, with the contours of pipes and fittings</source>
            <translation>Die Fotos des Standpunkts nebeneinander zeigen, mit den Konturen der Rohre und Formstücke</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Pipe</name>
        <message>
            <source>Measure a pipe: one click inside it or one on each of its edges in a photograph</source>
            <translation>Ein Rohr messen: ein Klick hinein oder je einer auf seine beiden Kanten in einem Foto</translation>
        </message>
        <message>
            <source>Pipe</source>
            <translation>Rohr</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Preferences</name>
        <message>
            <source>Preferences ...</source>
            <translation>Einstellungen ...</translation>
        </message>
        <message>
            <source>Tables of your own, working range, tolerances, colours and threads</source>
            <translation>Eigene Tabellen, Arbeitsbereich, Toleranzen, Farben und Threads</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_ReconstructPicks</name>
        <message>
            <source>Reconstruct Picks</source>
            <translation>Markierungen rekonstruieren</translation>
        </message>
        <message>
            <source>Reconstruct the pipes that were picked in the station's photographs (picks.json)</source>
            <translation>Die in den Fotos des Standpunkts markierten Rohre rekonstruieren (picks.json)</translation>
        </message>
    </context>
    <context>
        <name>PipeWB_Report</name>
        <message>
            <source>Report</source>
            <translation>Bericht</translation>
        </message>
        <message>
            <source>Write a report of what was measured and how well, with charts and photographs, and open it in the browser</source>
            <translation>Einen Bericht schreiben, was wie gut gemessen wurde, mit Diagrammen und Fotos, und ihn im Browser öffnen</translation>
        </message>
    </context>
    <context>
        <name>PipeWorkbench</name>
        <message>
            <source>'{panel}' has results that are not applied. Close it without applying them?</source>
            <translation>„{panel}“ hat Ergebnisse, die nicht übernommen sind. Ohne sie zu übernehmen schließen?</translation>
        </message>
        <message>
            <source>'{panel}' is still open</source>
            <translation>„{panel}“ ist noch offen</translation>
        </message>
        <message>
            <source>... and {count} more</source>
            <translation>... und {count} weitere</translation>
        </message>
        <message>
            <source>0 indoors</source>
            <translation>0 in Gebäuden</translation>
        </message>
        <message>
            <source>&lt;b&gt;Station {frame}&lt;/b&gt;: σ₀ {sigma0}, edges ± {sigma} px, redundancy {redundancy}, {count} iterations, {ended}</source>
            <translation>&lt;b&gt;Standpunkt {frame}&lt;/b&gt;: σ₀ {sigma0}, Kanten ± {sigma} px, Redundanz {redundancy}, {count} Iterationen, {ended}</translation>
        </message>
        <message>
            <source>&lt;b&gt;{stations}&lt;/b&gt; become one: {pairs} pairs, {count} components, σ₀ {sigma0}</source>
            <translation>&lt;b&gt;{stations}&lt;/b&gt; werden eines: {pairs} Paare, {count} Bauteile, σ₀ {sigma0}</translation>
        </message>
        <message>
            <source>A click is</source>
            <translation>Ein Klick ist</translation>
        </message>
        <message>
            <source>A component that several insulations hold has the last one</source>
            <translation>Ein Bauteil, das zu mehreren Dämmungen gehört, hat die letzte</translation>
        </message>
        <message>
            <source>A file that is there is replaced</source>
            <translation>Eine vorhandene Datei wird ersetzt</translation>
        </message>
        <message>
            <source>A fixed one, or what it follows from: a table, the heat a metre may lose, ...</source>
            <translation>Eine feste, oder woraus sie sich ergibt: eine Tabelle, die Wärme, die ein Meter verlieren darf, ...</translation>
        </message>
        <message>
            <source>A folder with tables of your own</source>
            <translation>Ein Ordner mit eigenen Tabellen</translation>
        </message>
        <message>
            <source>A pipe whose measured diameter differs by more from the standard's is marked as approximate</source>
            <translation>Ein Rohr, dessen gemessener Durchmesser stärker von der Norm abweicht, wird als ungefähr gekennzeichnet</translation>
        </message>
        <message>
            <source>A station is a calibrated rig of cameras and its photographs, described by station.json. That of the example is in the document.</source>
            <translation>Ein Standpunkt ist ein kalibriertes Kamerasystem mit seinen Fotos, beschrieben in station.json. Der des Beispiels ist im Dokument.</translation>
        </message>
        <message>
            <source>A weak condition: what the images say clearly is stronger</source>
            <translation>Eine schwache Bedingung: Was die Bilder deutlich zeigen, ist stärker</translation>
        </message>
        <message>
            <source>Accept</source>
            <translation>Übernehmen</translation>
        </message>
        <message>
            <source>Accept the {count} ticked</source>
            <translation>Die {count} angekreuzten übernehmen</translation>
        </message>
        <message>
            <source>Add ...</source>
            <translation>Hinzufügen ...</translation>
        </message>
        <message>
            <source>Add a flange</source>
            <translation>Einen Flansch hinzufügen</translation>
        </message>
        <message>
            <source>Add a folder with tables</source>
            <translation>Einen Ordner mit Tabellen hinzufügen</translation>
        </message>
        <message>
            <source>Add the flange on the other side of the gasket as well, where one is seen</source>
            <translation>Auch den Flansch auf der anderen Seite der Dichtung hinzufügen, wenn einer zu sehen ist</translation>
        </message>
        <message>
            <source>Adjust</source>
            <translation>Ausgleichen</translation>
        </message>
        <message>
            <source>Adjust everything</source>
            <translation>Alles ausgleichen</translation>
        </message>
        <message>
            <source>Adjust over all photographs</source>
            <translation>Über alle Fotos ausgleichen</translation>
        </message>
        <message>
            <source>Adjustment</source>
            <translation>Ausgleichung</translation>
        </message>
        <message>
            <source>All components and the stations' places at once; takes some seconds per station</source>
            <translation>Alle Bauteile und die Orte der Standpunkte zugleich; dauert einige Sekunden je Standpunkt</translation>
        </message>
        <message>
            <source>All that are checked are merged into the frame of the reference</source>
            <translation>Alle angekreuzten werden in das System des Bezugs zusammengeführt</translation>
        </message>
        <message>
            <source>An IFC model with the pipes as designed, as IfcPipeSegment</source>
            <translation>Ein IFC-Modell mit den geplanten Rohren als IfcPipeSegment</translation>
        </message>
        <message>
            <source>An arrow from each contour point that counts to its edge, enlarged by the window's slider</source>
            <translation>Ein Pfeil von jedem zählenden Konturpunkt zu seiner Kante, verlängert nach dem Regler des Fensters</translation>
        </message>
        <message>
            <source>Angle</source>
            <translation>Winkel</translation>
        </message>
        <message>
            <source>Angle °</source>
            <translation>Winkel °</translation>
        </message>
        <message>
            <source>Approximate from a deviation of</source>
            <translation>Ungefähr ab einer Abweichung von</translation>
        </message>
        <message>
            <source>Approximate pipe</source>
            <translation>Ungefähres Rohr</translation>
        </message>
        <message>
            <source>Around what is insulated in the document</source>
            <translation>Um alles, was im Dokument gedämmt ist</translation>
        </message>
        <message>
            <source>As built</source>
            <translation>Bestand</translation>
        </message>
        <message>
            <source>As built; in red where the design has another, which the tooltip tells</source>
            <translation>Im Bestand; rot, wo die Planung einen anderen hat, den der Hinweis nennt</translation>
        </message>
        <message>
            <source>As designed</source>
            <translation>Planung</translation>
        </message>
        <message>
            <source>Assign Selected</source>
            <translation>Ausgewählte zuordnen</translation>
        </message>
        <message>
            <source>Assigned by hand: {pairs}</source>
            <translation>Von Hand zugeordnet: {pairs}</translation>
        </message>
        <message>
            <source>At</source>
            <translation>An</translation>
        </message>
        <message>
            <source>At most</source>
            <translation>Höchstens</translation>
        </message>
        <message>
            <source>Bad</source>
            <translation>Schlecht</translation>
        </message>
        <message>
            <source>Bend</source>
            <translation>Bauart</translation>
        </message>
        <message>
            <source>Bend radius of the chosen elbow: one of the standard, or a free one</source>
            <translation>Biegeradius des gewählten Bogens: einer der Norm oder ein freier</translation>
        </message>
        <message>
            <source>Bends</source>
            <translation>Bögen</translation>
        </message>
        <message>
            <source>Bends, flanges</source>
            <translation>Bögen, Flansche</translation>
        </message>
        <message>
            <source>Between</source>
            <translation>Zwischen</translation>
        </message>
        <message>
            <source>Between a flange's rim and the inside of its box</source>
            <translation>Zwischen dem Rand eines Flansches und dem Inneren seiner Kappe</translation>
        </message>
        <message>
            <source>Between both after the adjustment of the stations' places; of pipes the larger of both ends</source>
            <translation>Zwischen beiden nach der Ausgleichung der Orte; bei Rohren der größere an beiden Enden</translation>
        </message>
        <message>
            <source>Between both axes</source>
            <translation>Zwischen beiden Achsen</translation>
        </message>
        <message>
            <source>Between the faces of two flanges that are bolted together</source>
            <translation>Zwischen den Dichtflächen zweier verschraubter Flansche</translation>
        </message>
        <message>
            <source>Boxes of two half shells, or nothing</source>
            <translation>Kappen aus zwei Halbschalen oder nichts</translation>
        </message>
        <message>
            <source>Brightens the dark parts to the right, darkens to the left</source>
            <translation>Nach rechts werden dunkle Stellen heller, nach links dunkler</translation>
        </message>
        <message>
            <source>Brightness</source>
            <translation>Helligkeit</translation>
        </message>
        <message>
            <source>By</source>
            <translation>Um</translation>
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
            <translation>Abbrechen</translation>
        </message>
        <message>
            <source>Cancelling: waiting for the end of this step ...</source>
            <translation>Wird abgebrochen, sobald dieser Schritt zu Ende ist ...</translation>
        </message>
        <message>
            <source>Cap</source>
            <translation>Kappe</translation>
        </message>
        <message>
            <source>Change the insulation</source>
            <translation>Dämmung ändern</translation>
        </message>
        <message>
            <source>Choose another type for {name}; its face stays where it is.</source>
            <translation>Wählen Sie einen anderen Typ für {name}; seine Dichtfläche bleibt, wo sie ist.</translation>
        </message>
        <message>
            <source>Choose folder and name</source>
            <translation>Ordner und Namen wählen</translation>
        </message>
        <message>
            <source>Choose one of the places it fits at ...</source>
            <translation>Einen der passenden Orte wählen ...</translation>
        </message>
        <message>
            <source>Choose the file</source>
            <translation>Die Datei wählen</translation>
        </message>
        <message>
            <source>Choose the folder that the photographs are in now</source>
            <translation>Den Ordner wählen, in dem die Fotos jetzt sind</translation>
        </message>
        <message>
            <source>Choose the tool and click on both edges of a pipe in one photograph, or once inside it. The proposed pipe is drawn into all photographs; Enter accepts it, digits choose another proposal, Esc steps back.</source>
            <translation>Wählen Sie das Werkzeug und klicken Sie in einem Foto auf beide Kanten eines Rohrs oder einmal hinein. Das vorgeschlagene Rohr wird in alle Fotos gezeichnet; Enter übernimmt es, Ziffern wählen einen anderen Vorschlag, Esc geht einen Schritt zurück.</translation>
        </message>
        <message>
            <source>Clear</source>
            <translation>Verwerfen</translation>
        </message>
        <message>
            <source>Clearance</source>
            <translation>Luft</translation>
        </message>
        <message>
            <source>Click again, change the diameter, or step back with Esc.</source>
            <translation>Klicken Sie noch einmal, ändern Sie den Durchmesser oder gehen Sie mit Esc zurück.</translation>
        </message>
        <message>
            <source>Click inside a pipe, or on one of its edges.</source>
            <translation>Klicken Sie in ein Rohr oder auf eine seiner Kanten.</translation>
        </message>
        <message>
            <source>Click on a flange of a pipe, then choose its type and pressure class from those that fit.</source>
            <translation type="vanished">Klicken Sie auf einen Flansch eines Rohrs und wählen Sie Typ und Druckstufe aus den passenden aus.</translation>
        </message>
        <message>
            <source>Click on a proposal to choose it; Enter accepts it, Esc leaves</source>
            <translation>Einen Vorschlag anklicken, um ihn zu wählen; Enter übernimmt ihn, Esc beendet</translation>
        </message>
        <message>
            <source>Click on the other edge of the pipe, in the same photograph.</source>
            <translation>Klicken Sie im selben Foto auf die andere Kante des Rohrs.</translation>
        </message>
        <message>
            <source>Click on the straight edge of a flange's rim, then choose its type and pressure class from those that fit; Enter accepts it.</source>
            <translation>Klicken Sie auf die gerade Kante eines Flanschrands, dann wählen Sie Typ und Druckstufe unter den passenden; die Eingabetaste übernimmt ihn.</translation>
        </message>
        <message>
            <source>Click on the straight edge of a flange's rim. Its pipe must have been measured.</source>
            <translation>Klicken Sie auf die gerade Kante eines Flanschrands. Sein Rohr muss schon gemessen sein.</translation>
        </message>
        <message>
            <source>Click to choose another colour</source>
            <translation>Klicken, um eine andere Farbe zu wählen</translation>
        </message>
        <message>
            <source>Close the guide; the document stays open</source>
            <translation>Die Anleitung schließen; das Dokument bleibt offen</translation>
        </message>
        <message>
            <source>Colours</source>
            <translation>Farben</translation>
        </message>
        <message>
            <source>Colours in 3D</source>
            <translation>Farben in 3D</translation>
        </message>
        <message>
            <source>Colours of the contours</source>
            <translation>Farben der Konturen</translation>
        </message>
        <message>
            <source>Colours of the contours and length of the residuals</source>
            <translation>Farben der Konturen und Länge der Restabweichungen</translation>
        </message>
        <message>
            <source>Compare</source>
            <translation>Vergleichen</translation>
        </message>
        <message>
            <source>Compare with</source>
            <translation>Vergleichen mit</translation>
        </message>
        <message>
            <source>Component</source>
            <translation>Bauteil</translation>
        </message>
        <message>
            <source>Components</source>
            <translation>Bauteile</translation>
        </message>
        <message>
            <source>Components that are fixed, or not selected, stay where they are</source>
            <translation>Festgelegte und nicht ausgewählte Bauteile bleiben, wo sie sind</translation>
        </message>
        <message>
            <source>Compute the adjustment; the document stays as it is until you apply it</source>
            <translation>Die Ausgleichung berechnen; das Dokument bleibt, wie es ist, bis Sie sie übernehmen</translation>
        </message>
        <message>
            <source>Computer</source>
            <translation>Rechner</translation>
        </message>
        <message>
            <source>Confidence</source>
            <translation>Sicherheit</translation>
        </message>
        <message>
            <source>Confidence from</source>
            <translation type="vanished">Sicherheit ab</translation>
        </message>
        <message>
            <source>Contours</source>
            <translation>Konturen</translation>
        </message>
        <message>
            <source>Contours of the pipes and fittings</source>
            <translation>Konturen der Rohre und Formstücke</translation>
        </message>
        <message>
            <source>Contrast</source>
            <translation>Kontrast</translation>
        </message>
        <message>
            <source>Contrast and brightness of the photographs</source>
            <translation>Kontrast und Helligkeit der Fotos</translation>
        </message>
        <message>
            <source>Contrast of the photographs</source>
            <translation>Kontrast der Fotos</translation>
        </message>
        <message>
            <source>Cost/a</source>
            <translation>Kosten/a</translation>
        </message>
        <message>
            <source>Cut and material lists</source>
            <translation>Stück- und Materiallisten</translation>
        </message>
        <message>
            <source>Cut list</source>
            <translation>Stückliste</translation>
        </message>
        <message>
            <source>Cut list...</source>
            <translation>Stückliste...</translation>
        </message>
        <message>
            <source>Cut sheets</source>
            <translation>Zuschnitte</translation>
        </message>
        <message>
            <source>Cut sheets...</source>
            <translation>Zuschnitte...</translation>
        </message>
        <message>
            <source>D {D:g} mm, C {C:g} mm, length {length:g} mm</source>
            <translation>D {D:g} mm, C {C:g} mm, Länge {length:g} mm</translation>
        </message>
        <message>
            <source>Dash what is hidden</source>
            <translation>Verdecktes stricheln</translation>
        </message>
        <message>
            <source>Deviations</source>
            <translation>Abweichungen</translation>
        </message>
        <message>
            <source>Diameter</source>
            <translation>Durchmesser</translation>
        </message>
        <message>
            <source>Diameter mm</source>
            <translation>Durchmesser mm</translation>
        </message>
        <message>
            <source>Diameters, bend radii and flange dimensions of standards; sizes that are no standard's are always measured</source>
            <translation>Durchmesser, Biegeradien und Flanschmaße der Normen; andere Größen werden immer gemessen</translation>
        </message>
        <message>
            <source>Display</source>
            <translation>Anzeige</translation>
        </message>
        <message>
            <source>Distance</source>
            <translation>Abstand</translation>
        </message>
        <message>
            <source>Distance [mm]</source>
            <translation>Abstand [mm]</translation>
        </message>
        <message>
            <source>Distance mm</source>
            <translation>Abstand mm</translation>
        </message>
        <message>
            <source>Distance of the farthest pipes from the cameras</source>
            <translation>Entfernung der fernsten Rohre von den Kameras</translation>
        </message>
        <message>
            <source>Distance of the nearest pipes from the cameras</source>
            <translation>Entfernung der nächsten Rohre von den Kameras</translation>
        </message>
        <message>
            <source>Down</source>
            <translation>Nach unten</translation>
        </message>
        <message>
            <source>Drag to make the pipe thicker or thinner: it moves away or nearer, so that its clicked edges stay</source>
            <translation>Ziehen macht das Rohr dicker oder dünner: Es rückt ferner oder näher, sodass seine angeklickten Kanten bleiben</translation>
        </message>
        <message>
            <source>Edges</source>
            <translation>Kanten</translation>
        </message>
        <message>
            <source>Edges %</source>
            <translation>Kanten %</translation>
        </message>
        <message>
            <source>Edges found in the photographs, with subpixel accuracy</source>
            <translation>In den Fotos gefundene Kanten, subpixelgenau</translation>
        </message>
        <message>
            <source>Edges within</source>
            <translation>Kanten innerhalb</translation>
        </message>
        <message>
            <source>Efficiency</source>
            <translation>Nutzungsgrad</translation>
        </message>
        <message>
            <source>Elbow</source>
            <translation>Bogen</translation>
        </message>
        <message>
            <source>Elbows</source>
            <translation>Bögen</translation>
        </message>
        <message>
            <source>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs, Enter accepts it.</source>
            <translation>Bögen ergeben sich aus den Achsen der Rohre; wählen Sie den Biegeradius, der zu den Fotos passt, die Eingabetaste übernimmt ihn.</translation>
        </message>
        <message>
            <source>Elbows are found from the pipes' axes; choose the bend radius that fits the photographs.</source>
            <translation type="vanished">Bögen werden aus den Achsen der Rohre gefunden; wählen Sie den Biegeradius, der zu den Fotos passt.</translation>
        </message>
        <message>
            <source>Else all components are compared</source>
            <translation>Sonst werden alle Bauteile verglichen</translation>
        </message>
        <message>
            <source>End the tour</source>
            <translation>Tour beenden</translation>
        </message>
        <message>
            <source>Ends that face each other and are not farther apart are joined</source>
            <translation>Enden, die einander gegenüberliegen und nicht weiter entfernt sind, werden verbunden</translation>
        </message>
        <message>
            <source>Energy that is bought for it in a year</source>
            <translation>Energie, die dafür im Jahr eingekauft wird</translation>
        </message>
        <message>
            <source>Enlarge the pixels around the pointer (L)</source>
            <translation>Die Pixel um den Mauszeiger vergrößern (L)</translation>
        </message>
        <message>
            <source>Enter accepts the flange. Choose another type if it is not the right one.</source>
            <translation>Enter übernimmt den Flansch. Wählen Sie einen anderen Typ, wenn er nicht der richtige ist.</translation>
        </message>
        <message>
            <source>Enter accepts the pipe. Digits choose another one. Esc steps back.</source>
            <translation>Enter übernimmt das Rohr. Ziffern wählen ein anderes. Esc geht zurück.</translation>
        </message>
        <message>
            <source>Everything that is known, for this program's command line</source>
            <translation>Alles, was bekannt ist, für die Befehlszeile dieses Programms</translation>
        </message>
        <message>
            <source>Exactly as in the standard</source>
            <translation>Genau wie in der Norm</translation>
        </message>
        <message>
            <source>Example project</source>
            <translation>Beispielprojekt</translation>
        </message>
        <message>
            <source>Export</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>Export it</source>
            <translation>Exportieren</translation>
        </message>
        <message>
            <source>Fair</source>
            <translation>Mittel</translation>
        </message>
        <message>
            <source>Fair up to</source>
            <translation>Mittel bis</translation>
        </message>
        <message>
            <source>File</source>
            <translation>Datei</translation>
        </message>
        <message>
            <source>Find Photographs</source>
            <translation>Fotos suchen</translation>
        </message>
        <message>
            <source>Find Pipes</source>
            <translation>Rohre finden</translation>
        </message>
        <message>
            <source>Find What They Share</source>
            <translation>Gemeinsames suchen</translation>
        </message>
        <message>
            <source>Find them...</source>
            <translation>Suchen ...</translation>
        </message>
        <message>
            <source>Finding pipes</source>
            <translation>Rohre werden gesucht</translation>
        </message>
        <message>
            <source>First and last</source>
            <translation>Erstes, letztes</translation>
        </message>
        <message>
            <source>First steps</source>
            <translation>Erste Schritte</translation>
        </message>
        <message>
            <source>Fit</source>
            <translation>Einpassen</translation>
        </message>
        <message>
            <source>Fit the model to the pipework</source>
            <translation>Das Modell an die Rohrleitung anpassen</translation>
        </message>
        <message>
            <source>Fix the outside diameter; the projection follows, and the pipe is measured with it</source>
            <translation>Den Außendurchmesser festlegen; die Projektion folgt, und das Rohr wird damit gemessen</translation>
        </message>
        <message>
            <source>Fixed at</source>
            <translation>Festgelegt auf</translation>
        </message>
        <message>
            <source>Flange</source>
            <translation>Flansch</translation>
        </message>
        <message>
            <source>Flange: click on the straight edge of its rim</source>
            <translation>Flansch: auf die gerade Kante seines Rands klicken</translation>
        </message>
        <message>
            <source>Flanges</source>
            <translation>Flansche</translation>
        </message>
        <message>
            <source>Folder with the photographs</source>
            <translation>Ordner mit den Fotos</translation>
        </message>
        <message>
            <source>Folders with CSV files of your own; a table takes the place of the same one further up and of the standards'</source>
            <translation>Ordner mit eigenen CSV-Dateien; was weiter unten steht, ersetzt Gleiches weiter oben und in den Normen</translation>
        </message>
        <message>
            <source>For BIM: pipe segments and fittings with their dimensions and accuracy</source>
            <translation>Für BIM: Rohre und Formteile mit ihren Maßen und ihrer Genauigkeit</translation>
        </message>
        <message>
            <source>For CAD: named solids, coloured by kind</source>
            <translation>Für CAD: benannte Körper, nach Art gefärbt</translation>
        </message>
        <message>
            <source>For estimating and purchasing: a line per item with its quantity</source>
            <translation>Für Kalkulation und Einkauf: eine Zeile je Position mit ihrer Menge</translation>
        </message>
        <message>
            <source>For isometrics: components with their ends, bores and items</source>
            <translation>Für Isometrien: Bauteile mit Enden, Nennweiten und Positionen</translation>
        </message>
        <message>
            <source>For people: one file with dimensions, accuracy, charts and photographs</source>
            <translation>Für Menschen: eine Datei mit Maßen, Genauigkeiten, Diagrammen und Fotos</translation>
        </message>
        <message>
            <source>For spreadsheets: a line per component</source>
            <translation>Für Tabellenkalkulationen: eine Zeile je Bauteil</translation>
        </message>
        <message>
            <source>For the shop and purchasing: parts, sheets and materials of the insulation</source>
            <translation>Für Werkstatt und Einkauf: Teile, Tafeln und Werkstoffe der Dämmung</translation>
        </message>
        <message>
            <source>For the shop: the insulation's parts of sheet metal, laid out on sheets</source>
            <translation>Für die Werkstatt: die Blechteile der Dämmung, auf Tafeln verteilt</translation>
        </message>
        <message>
            <source>Forget</source>
            <translation>Vergessen</translation>
        </message>
        <message>
            <source>Forget the click</source>
            <translation>Den Klick vergessen</translation>
        </message>
        <message>
            <source>Forget the clicks</source>
            <translation>Die Klicks vergessen</translation>
        </message>
        <message>
            <source>Format</source>
            <translation>Format</translation>
        </message>
        <message>
            <source>Free bend radius; the projection follows</source>
            <translation>Freier Biegeradius; die Projektion folgt</translation>
        </message>
        <message>
            <source>Free, as measured</source>
            <translation>Frei, wie gemessen</translation>
        </message>
        <message>
            <source>From</source>
            <translation>Von</translation>
        </message>
        <message>
            <source>From photographs to a pipeline. Each step is checked off when the document shows it done; undo opens it again.</source>
            <translation>Von Fotos zur Rohrleitung. Jeder Schritt wird abgehakt, sobald er im Dokument getan ist; Rückgängig öffnet ihn wieder.</translation>
        </message>
        <message>
            <source>From the design to what was built</source>
            <translation>Von der Planung zum Bestand</translation>
        </message>
        <message>
            <source>Gamma</source>
            <translation>Gamma</translation>
        </message>
        <message>
            <source>Gasket</source>
            <translation>Dichtung</translation>
        </message>
        <message>
            <source>Good</source>
            <translation>Gut</translation>
        </message>
        <message>
            <source>Good up to</source>
            <translation>Gut bis</translation>
        </message>
        <message>
            <source>Good up to a quality of</source>
            <translation type="vanished">Gut bis zu einer Güte von</translation>
        </message>
        <message>
            <source>Green within the first limit, yellow up to the second, red beyond; grey has no counterpart</source>
            <translation>Grün innerhalb der ersten Grenze, gelb bis zur zweiten, rot darüber; Graues hat kein Gegenstück</translation>
        </message>
        <message>
            <source>Heading</source>
            <translation>Überschrift</translation>
        </message>
        <message>
            <source>Heat W</source>
            <translation>Wärme W</translation>
        </message>
        <message>
            <source>Heat delivered over energy bought: 0.9 of a boiler, 3 of a heat pump</source>
            <translation>Gelieferte Wärme je eingekaufter Energie: 0,9 bei einem Kessel, 3 bei einer Wärmepumpe</translation>
        </message>
        <message>
            <source>Heat that a metre of pipe may lose, or temperature of the surface</source>
            <translation>Wärme, die ein Meter Rohr verlieren darf, oder Temperatur der Oberfläche</translation>
        </message>
        <message>
            <source>Hours in a year</source>
            <translation>Stunden im Jahr</translation>
        </message>
        <message>
            <source>How far from the contours edges are looked for: more where components lie beside their pictures</source>
            <translation>Wie weit von den Konturen nach Kanten gesucht wird: mehr, wo Bauteile neben ihren Bildern liegen</translation>
        </message>
        <message>
            <source>How far its axis turns</source>
            <translation>Wie weit sich seine Achse dreht</translation>
        </message>
        <message>
            <source>How far its middle moves; of pipes across their axis</source>
            <translation>Wie weit sich seine Mitte bewegt; bei Rohren quer zur Achse</translation>
        </message>
        <message>
            <source>How long the first and the last piece of a bend are</source>
            <translation>Wie lang das erste und das letzte Segment eines Bogens sind</translation>
        </message>
        <message>
            <source>How many parts of the processor are used at most</source>
            <translation>Wie viele Teile des Prozessors höchstens benutzt werden</translation>
        </message>
        <message>
            <source>How many times their length residuals are drawn</source>
            <translation>Wievielfach verlängert Restabweichungen gezeichnet werden</translation>
        </message>
        <message>
            <source>How near to an edge the pointer must be, in pixels of the screen</source>
            <translation>Wie nahe der Mauszeiger einer Kante sein muss, in Pixeln des Bildschirms</translation>
        </message>
        <message>
            <source>How the adjustment treats diameters and bend radii of the standards</source>
            <translation>Wie die Ausgleichung Durchmesser und Biegeradien der Normen behandelt</translation>
        </message>
        <message>
            <source>IFC</source>
            <translation>IFC</translation>
        </message>
        <message>
            <source>IFC4 is what most programs read</source>
            <translation>IFC4 lesen die meisten Programme</translation>
        </message>
        <message>
            <source>Import a station</source>
            <translation>Einen Standpunkt importieren</translation>
        </message>
        <message>
            <source>In the browser</source>
            <translation>Im Browser</translation>
        </message>
        <message>
            <source>In the document: {names}</source>
            <translation>Im Dokument: {names}</translation>
        </message>
        <message>
            <source>In the station that was there before</source>
            <translation>Im Standpunkt, der schon da war</translation>
        </message>
        <message>
            <source>Insulate</source>
            <translation>Dämmen</translation>
        </message>
        <message>
            <source>Insulation</source>
            <translation>Dämmung</translation>
        </message>
        <message>
            <source>Insulation, a bare component or an obstacle</source>
            <translation>Dämmung, ein ungedämmtes Bauteil oder ein Hindernis</translation>
        </message>
        <message>
            <source>Jacket</source>
            <translation>Mantel</translation>
        </message>
        <message>
            <source>Join ends up to</source>
            <translation>Enden verbinden bis</translation>
        </message>
        <message>
            <source>Joints to components that are left out are left out, too</source>
            <translation>Verbindungen zu weggelassenen Bauteilen fallen ebenfalls weg</translation>
        </message>
        <message>
            <source>Kind</source>
            <translation>Art</translation>
        </message>
        <message>
            <source>Kinds of components</source>
            <translation>Arten von Bauteilen</translation>
        </message>
        <message>
            <source>LOA</source>
            <translation>LOA</translation>
        </message>
        <message>
            <source>Language</source>
            <translation>Sprache</translation>
        </message>
        <message>
            <source>Largest distance {distance:.1f} mm.</source>
            <translation>Größter Abstand {distance:.1f} mm.</translation>
        </message>
        <message>
            <source>Layers</source>
            <translation>Lagen</translation>
        </message>
        <message>
            <source>Leave the specification's rules and obstacles away</source>
            <translation>Die Regeln und Hindernisse der Spezifikation weglassen</translation>
        </message>
        <message>
            <source>Length</source>
            <translation>Länge</translation>
        </message>
        <message>
            <source>Length of the residuals</source>
            <translation>Länge der Restabweichungen</translation>
        </message>
        <message>
            <source>Level of accuracy (USIBD)</source>
            <translation>Genauigkeitsstufe (LOA nach USIBD)</translation>
        </message>
        <message>
            <source>Level, plumb and square runs</source>
            <translation>Waagerechte, lotrechte und rechtwinklige Stränge</translation>
        </message>
        <message>
            <source>Limit of Baarda's test; 3.29 takes one good observation of a thousand for an outlier</source>
            <translation>Grenzwert des Tests nach Baarda; bei 3,29 gilt eine von tausend guten Beobachtungen als Ausreißer</translation>
        </message>
        <message>
            <source>Loading the photograph...</source>
            <translation>Das Foto wird geladen ...</translation>
        </message>
        <message>
            <source>Longer by</source>
            <translation>Länger um</translation>
        </message>
        <message>
            <source>Look how the stations lie to each other; the document stays as it is until you press OK</source>
            <translation>Suchen, wie die Standpunkte zueinander liegen; das Dokument bleibt, wie es ist, bis Sie OK drücken</translation>
        </message>
        <message>
            <source>Looking ...</source>
            <translation>Wird gesucht ...</translation>
        </message>
        <message>
            <source>Looking for more ...</source>
            <translation>Weitere werden gesucht ...</translation>
        </message>
        <message>
            <source>Looking for the rim ...</source>
            <translation>Der Rand wird gesucht ...</translation>
        </message>
        <message>
            <source>Loupe</source>
            <translation>Lupe</translation>
        </message>
        <message>
            <source>Material</source>
            <translation>Material</translation>
        </message>
        <message>
            <source>Material of a layer around the first</source>
            <translation>Material einer Lage um die erste</translation>
        </message>
        <message>
            <source>Measure a pipe</source>
            <translation>Ein Rohr messen</translation>
        </message>
        <message>
            <source>Measure the deviations; the document stays as it is</source>
            <translation>Die Abweichungen messen; das Dokument bleibt, wie es ist</translation>
        </message>
        <message>
            <source>Measure the next pipe</source>
            <translation>Das nächste Rohr messen</translation>
        </message>
        <message>
            <source>Measure the pipe around the corner</source>
            <translation type="vanished">Das Rohr um die Ecke messen</translation>
        </message>
        <message>
            <source>Measure the pipe that goes on behind a bend of the first one.</source>
            <translation type="vanished">Messen Sie das Rohr, das hinter einem Bogen des ersten weitergeht.</translation>
        </message>
        <message>
            <source>Measure the pipe that goes on behind a bend of the first one; the tool stays open for it.</source>
            <translation>Messen Sie das Rohr, das hinter einem Bogen des ersten weitergeht; das Werkzeug bleibt dafür offen.</translation>
        </message>
        <message>
            <source>Measuring</source>
            <translation>Messen</translation>
        </message>
        <message>
            <source>Measuring ...</source>
            <translation>Wird gemessen ...</translation>
        </message>
        <message>
            <source>Medium</source>
            <translation>Medium</translation>
        </message>
        <message>
            <source>Merge Stations</source>
            <translation>Standpunkte zusammenführen</translation>
        </message>
        <message>
            <source>Move the chosen folder down: its tables come before those above</source>
            <translation>Den gewählten Ordner nach unten verschieben: Seine Tabellen gehen denen darüber vor</translation>
        </message>
        <message>
            <source>Move the chosen folder up</source>
            <translation>Den gewählten Ordner nach oben verschieben</translation>
        </message>
        <message>
            <source>Next</source>
            <translation>Nächstes</translation>
        </message>
        <message>
            <source>No elbows are seen between the free ends of the pipes. Measure the pipes on both sides of a bend, or select two pipes.</source>
            <translation>Zwischen den freien Rohrenden sind keine Bögen zu sehen. Messen Sie die Rohre auf beiden Seiten eines Bogens oder wählen Sie zwei Rohre aus.</translation>
        </message>
        <message>
            <source>No further pipes are seen. Click on those that are missing with the Pipe tool.</source>
            <translation>Weitere Rohre sind nicht zu sehen. Klicken Sie die fehlenden mit dem Werkzeug „Rohr“ an.</translation>
        </message>
        <message>
            <source>No tees, reducers or caps are seen at the free ends of the pipes. Select the pipes that belong to one.</source>
            <translation>An den freien Rohrenden sind keine T-Stücke, Reduzierstücke oder Kappen zu sehen. Wählen Sie die Rohre aus, die zu einem gehören.</translation>
        </message>
        <message>
            <source>None: everything is determined and nothing is weakly placed.</source>
            <translation>Keine: Alles ist bestimmt, und nichts liegt unsicher.</translation>
        </message>
        <message>
            <source>Not measured</source>
            <translation>Nicht gemessen</translation>
        </message>
        <message>
            <source>Note</source>
            <translation>Hinweis</translation>
        </message>
        <message>
            <source>Nothing is insulated yet: use Insulation first.</source>
            <translation>Noch ist nichts gedämmt: zuerst Dämmung verwenden.</translation>
        </message>
        <message>
            <source>Of a segmented bend</source>
            <translation>Eines Segmentbogens</translation>
        </message>
        <message>
            <source>Of operation</source>
            <translation>In Betrieb</translation>
        </message>
        <message>
            <source>Of straight pieces of sheet metal, or round as foam shells are</source>
            <translation>Aus geraden Blechsegmenten oder rund wie Schaumschalen</translation>
        </message>
        <message>
            <source>Of the axes, the larger of both ends of what they have in common; of surfaces the shortest</source>
            <translation>Der Achsen, der größere an beiden Enden des gemeinsamen Stücks; bei Flächen der kürzeste</translation>
        </message>
        <message>
            <source>Of the distances between contours and edges</source>
            <translation>Der Abstände zwischen Konturen und Kanten</translation>
        </message>
        <message>
            <source>Of the energy that is bought</source>
            <translation>Der eingekauften Energie</translation>
        </message>
        <message>
            <source>Of the finished surfaces; negative where they overlap</source>
            <translation>Der fertigen Oberflächen; negativ, wo sie sich überschneiden</translation>
        </message>
        <message>
            <source>Of the inner layer</source>
            <translation>Der inneren Lage</translation>
        </message>
        <message>
            <source>Of the report's texts</source>
            <translation type="vanished">Der Texte des Berichts</translation>
        </message>
        <message>
            <source>Of the texts in the file</source>
            <translation>Der Texte in der Datei</translation>
        </message>
        <message>
            <source>Open it afterwards</source>
            <translation>Danach öffnen</translation>
        </message>
        <message>
            <source>Open its photo window</source>
            <translation>Sein Fotofenster öffnen</translation>
        </message>
        <message>
            <source>Operation</source>
            <translation>Betrieb</translation>
        </message>
        <message>
            <source>Otherwise selected components follow their own edges, and gaps may open to their neighbours</source>
            <translation>Sonst folgen ausgewählte Bauteile ihren eigenen Kanten, und zu den Nachbarn können Lücken entstehen</translation>
        </message>
        <message>
            <source>Outliers</source>
            <translation>Ausreißer</translation>
        </message>
        <message>
            <source>Outliers from</source>
            <translation>Ausreißer ab</translation>
        </message>
        <message>
            <source>Outside diameters from</source>
            <translation>Außendurchmesser von</translation>
        </message>
        <message>
            <source>Part of the contours' samples that have an edge</source>
            <translation>Anteil der Konturpunkte, die eine Kante haben</translation>
        </message>
        <message>
            <source>Photograph</source>
            <translation>Foto</translation>
        </message>
        <message>
            <source>Photographs</source>
            <translation>Fotos</translation>
        </message>
        <message>
            <source>Photographs with contours</source>
            <translation>Fotos mit Konturen</translation>
        </message>
        <message>
            <source>Pick {index} failed: {reason}.</source>
            <translation>Markierung {index} ergab nichts: {reason}.</translation>
        </message>
        <message>
            <source>Picks</source>
            <translation>Markierungen</translation>
        </message>
        <message>
            <source>Pictures of the cut sheets</source>
            <translation>Bilder der Zuschnitte</translation>
        </message>
        <message>
            <source>Pieces</source>
            <translation>Segmente</translation>
        </message>
        <message>
            <source>Pipe</source>
            <translation>Rohr</translation>
        </message>
        <message>
            <source>Pipe Workbench pipeline</source>
            <translation>Pipe-Workbench-Rohrleitung</translation>
        </message>
        <message>
            <source>Pipe: click inside it, or on both its edges</source>
            <translation>Rohr: hineinklicken oder auf beide Kanten</translation>
        </message>
        <message>
            <source>Pipes from</source>
            <translation>Rohre von</translation>
        </message>
        <message>
            <source>Pipes of an IFC file</source>
            <translation>Rohre einer IFC-Datei</translation>
        </message>
        <message>
            <source>Pipes of selected solids</source>
            <translation>Rohre ausgewählter Körper</translation>
        </message>
        <message>
            <source>Pipes that are nearly level, plumb or at right angles are so</source>
            <translation>Fast waagerechte, lotrechte oder rechtwinklige Rohre sind es auch</translation>
        </message>
        <message>
            <source>Piping component file</source>
            <translation>Piping Component File</translation>
        </message>
        <message>
            <source>Poor</source>
            <translation>Schwach</translation>
        </message>
        <message>
            <source>Poor from a quality of</source>
            <translation type="vanished">Schlecht ab einer Güte von</translation>
        </message>
        <message>
            <source>Poor up to</source>
            <translation>Schwach bis</translation>
        </message>
        <message>
            <source>Preview</source>
            <translation>Vorschau</translation>
        </message>
        <message>
            <source>Price</source>
            <translation>Preis</translation>
        </message>
        <message>
            <source>Put all that are ticked into the document</source>
            <translation>Alle angekreuzten ins Dokument übernehmen</translation>
        </message>
        <message>
            <source>Put the chosen one into the document (Enter)</source>
            <translation>Den gewählten ins Dokument übernehmen (Enter)</translation>
        </message>
        <message>
            <source>Put the chosen pipe into the document (Enter)</source>
            <translation>Das gewählte Rohr ins Dokument übernehmen (Enter)</translation>
        </message>
        <message>
            <source>Put the elbow between them</source>
            <translation>Den Bogen dazwischen setzen</translation>
        </message>
        <message>
            <source>Put the flange into the document (Enter)</source>
            <translation>Den Flansch ins Dokument übernehmen (Enter)</translation>
        </message>
        <message>
            <source>Quality</source>
            <translation>Güte</translation>
        </message>
        <message>
            <source>Quality and accuracy</source>
            <translation type="vanished">Güte und Genauigkeit</translation>
        </message>
        <message>
            <source>Quality is the root mean square distance of a component's contour from the edges in the photographs</source>
            <translation>Die Güte ist der mittlere quadratische Abstand der Kontur eines Bauteils von den Kanten in den Fotos</translation>
        </message>
        <message>
            <source>RMS distance of its contours to the edges (Eq. 4) before and after</source>
            <translation>Mittlerer quadratischer Abstand seiner Konturen zu den Kanten (Gl. 4) vorher und nachher</translation>
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
            <translation>Lagen, Regeln für einzelne Bauteile und Hindernisse einlesen</translation>
        </message>
        <message>
            <source>Reconstruct picks</source>
            <translation>Markierungen rekonstruieren</translation>
        </message>
        <message>
            <source>Reconstructing picks</source>
            <translation>Markierungen werden rekonstruiert</translation>
        </message>
        <message>
            <source>Reducer</source>
            <translation>Reduzierstück</translation>
        </message>
        <message>
            <source>Reference</source>
            <translation>Bezug</translation>
        </message>
        <message>
            <source>Reject</source>
            <translation>Ablehnen</translation>
        </message>
        <message>
            <source>Remove</source>
            <translation>Entfernen</translation>
        </message>
        <message>
            <source>Report</source>
            <translation>Bericht</translation>
        </message>
        <message>
            <source>Reset</source>
            <translation>Zurücksetzen</translation>
        </message>
        <message>
            <source>Residuals</source>
            <translation>Restabweichungen</translation>
        </message>
        <message>
            <source>Residuals in the photographs</source>
            <translation>Restabweichungen in den Fotos</translation>
        </message>
        <message>
            <source>Residuals of the last adjustment, enlarged</source>
            <translation>Restabweichungen der letzten Ausgleichung, vergrößert</translation>
        </message>
        <message>
            <source>Restore defaults</source>
            <translation>Standardwerte</translation>
        </message>
        <message>
            <source>Result</source>
            <translation>Ergebnis</translation>
        </message>
        <message>
            <source>Round outer faces of solids are taken for pipes; to a surface only the shortest distance is measured</source>
            <translation>Runde Außenflächen von Körpern gelten als Rohre; zu einer Fläche wird nur der kürzeste Abstand gemessen</translation>
        </message>
        <message>
            <source>Round up to what can be bought</source>
            <translation>Auf lieferbare Dicke aufrunden</translation>
        </message>
        <message>
            <source>Runs that are nearly so are taken to be so, with little weight: the photographs decide where they say something else</source>
            <translation>Stränge, die fast so liegen, gelten mit wenig Gewicht als solche: Wo die Fotos etwas anderes sagen, entscheiden sie</translation>
        </message>
        <message>
            <source>STEP solids</source>
            <translation>STEP-Körper</translation>
        </message>
        <message>
            <source>Same place</source>
            <translation>Gleicher Ort</translation>
        </message>
        <message>
            <source>Save as CSV ...</source>
            <translation>Als CSV speichern ...</translation>
        </message>
        <message>
            <source>Save deviations</source>
            <translation>Abweichungen speichern</translation>
        </message>
        <message>
            <source>Score</source>
            <translation>Wertung</translation>
        </message>
        <message>
            <source>Search band</source>
            <translation>Suchband</translation>
        </message>
        <message>
            <source>Second layer</source>
            <translation>Zweite Lage</translation>
        </message>
        <message>
            <source>Select the solids in the tree or in 3D.</source>
            <translation>Wählen Sie die Körper im Baum oder in 3D aus.</translation>
        </message>
        <message>
            <source>Selected components only</source>
            <translation>Nur ausgewählte Bauteile</translation>
        </message>
        <message>
            <source>Set everything on this page to what it was at first</source>
            <translation>Alles auf dieser Seite auf den ursprünglichen Wert setzen</translation>
        </message>
        <message>
            <source>Set-on branch</source>
            <translation>Aufgesetzter Abzweig</translation>
        </message>
        <message>
            <source>Sheet</source>
            <translation>Blech</translation>
        </message>
        <message>
            <source>Sheet metal around the insulation</source>
            <translation>Blech um die Dämmung</translation>
        </message>
        <message>
            <source>Shift mm</source>
            <translation>Versatz mm</translation>
        </message>
        <message>
            <source>Show one pixel of the photograph as one of the screen (Ctrl+1)</source>
            <translation>Ein Pixel des Fotos als eines des Bildschirms zeigen (Strg+1)</translation>
        </message>
        <message>
            <source>Show the insulation in 3D; the document stays as it is</source>
            <translation>Die Dämmung in 3D zeigen; das Dokument bleibt, wie es ist</translation>
        </message>
        <message>
            <source>Show the next pipe of the list (digits choose directly)</source>
            <translation>Das nächste Rohr der Liste zeigen (Ziffern wählen direkt)</translation>
        </message>
        <message>
            <source>Show the parts of the contours that are behind something as dashed lines</source>
            <translation>Verdeckte Teile der Konturen gestrichelt zeigen</translation>
        </message>
        <message>
            <source>Show the photographs as they are, stretched to the screen's range</source>
            <translation>Die Fotos zeigen, wie sie sind, auf den Bereich des Bildschirms gestreckt</translation>
        </message>
        <message>
            <source>Show the photographs whole (F)</source>
            <translation>Die Fotos ganz zeigen (F)</translation>
        </message>
        <message>
            <source>Show the same part of the object in the middle of all photographs</source>
            <translation>Denselben Teil des Objekts in der Mitte aller Fotos zeigen</translation>
        </message>
        <message>
            <source>Size</source>
            <translation>Größe</translation>
        </message>
        <message>
            <source>Snap to edges within</source>
            <translation>An Kanten einrasten innerhalb</translation>
        </message>
        <message>
            <source>Solids: {labels}</source>
            <translation>Körper: {labels}</translation>
        </message>
        <message>
            <source>Something else is still being computed; wait for its end or cancel it</source>
            <translation>Es wird noch etwas anderes berechnet; warten Sie das Ende ab oder brechen Sie es ab</translation>
        </message>
        <message>
            <source>Specification of insulation</source>
            <translation>Spezifikation der Dämmung</translation>
        </message>
        <message>
            <source>Specification {name}: {rules} rules, {obstacles} obstacles</source>
            <translation>Spezifikation {name}: {rules} Regeln, {obstacles} Hindernisse</translation>
        </message>
        <message>
            <source>Specification...</source>
            <translation>Spezifikation...</translation>
        </message>
        <message>
            <source>Standard</source>
            <translation>Norm</translation>
        </message>
        <message>
            <source>Standard deviation of its position before and after</source>
            <translation>Standardabweichung seiner Lage vorher und nachher</translation>
        </message>
        <message>
            <source>Standard sizes</source>
            <translation>Normgrößen</translation>
        </message>
        <message>
            <source>Standardised size (Baarda); 3.3 and more is a gross error</source>
            <translation>Normierte Größe (Baarda); ab 3,3 ist es ein grober Fehler</translation>
        </message>
        <message>
            <source>Station</source>
            <translation>Standpunkt</translation>
        </message>
        <message>
            <source>Station {name}: {count} components reconstructed</source>
            <translation>Standpunkt {name}: {count} Bauteile rekonstruiert</translation>
        </message>
        <message>
            <source>Station {name}: {count} photographs imported</source>
            <translation>Standpunkt {name}: {count} Fotos importiert</translation>
        </message>
        <message>
            <source>Station {station}: place ± {sigma:.2f} mm, heading ± {heading:.3f}°</source>
            <translation>Standpunkt {station}: Ort ± {sigma:.2f} mm, Richtung ± {heading:.3f}°</translation>
        </message>
        <message>
            <source>Stations</source>
            <translation>Standpunkte</translation>
        </message>
        <message>
            <source>Stay joined to what stays</source>
            <translation>Mit Bleibendem verbunden bleiben</translation>
        </message>
        <message>
            <source>Straight edges found in the photographs</source>
            <translation>In den Fotos gefundene gerade Kanten</translation>
        </message>
        <message>
            <source>Straight lines</source>
            <translation>Geraden</translation>
        </message>
        <message>
            <source>Surface of selected solids</source>
            <translation>Oberfläche ausgewählter Körper</translation>
        </message>
        <message>
            <source>Surroundings</source>
            <translation>Umgebung</translation>
        </message>
        <message>
            <source>Table</source>
            <translation>Tabelle</translation>
        </message>
        <message>
            <source>Tables of your own</source>
            <translation>Eigene Tabellen</translation>
        </message>
        <message>
            <source>Take back what was assigned by hand</source>
            <translation>Von Hand Zugeordnetes zurücknehmen</translation>
        </message>
        <message>
            <source>Take the chosen folder from the list; its files stay</source>
            <translation>Den gewählten Ordner aus der Liste nehmen; seine Dateien bleiben</translation>
        </message>
        <message>
            <source>Take the chosen one off the list</source>
            <translation>Den gewählten aus der Liste nehmen</translation>
        </message>
        <message>
            <source>Take-off list</source>
            <translation>Mengenauszug</translation>
        </message>
        <message>
            <source>Tee</source>
            <translation>T-Stück</translation>
        </message>
        <message>
            <source>Tees, Reducers and Caps</source>
            <translation>T-Stücke, Reduzierstücke und Kappen</translation>
        </message>
        <message>
            <source>Temperature of the air around</source>
            <translation>Temperatur der Luft umher</translation>
        </message>
        <message>
            <source>Temperature of what flows</source>
            <translation>Temperatur dessen, was fließt</translation>
        </message>
        <message>
            <source>That is all. Import photographs of your own with Import Station.</source>
            <translation type="vanished">Das ist alles. Importieren Sie eigene Fotos mit „Standpunkt importieren“.</translation>
        </message>
        <message>
            <source>That is all. The document's other tab shows the pipeline in 3D; the keys V and F, one after the other, fit the view. Import photographs of your own with Import Station.</source>
            <translation>Das ist alles. Der andere Reiter des Dokuments zeigt die Rohrleitung in 3D; die Tasten V und F nacheinander passen die Ansicht ein. Eigene Fotos kommen mit „Standpunkt importieren“ dazu.</translation>
        </message>
        <message>
            <source>That is beside the photograph: click inside it</source>
            <translation>Das liegt neben dem Foto: klicken Sie hinein</translation>
        </message>
        <message>
            <source>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous.</source>
            <translation type="vanished">Die Ausgleichung passt alle Bauteile zugleich an die Kanten aller Fotos an und macht die Rohrleitung durchgängig.</translation>
        </message>
        <message>
            <source>The adjustment fits all components to the edges of all photographs at once and makes the pipeline continuous. Press Adjust in the panel, look at what it would change, and take it with OK.</source>
            <translation>Die Ausgleichung passt alle Bauteile zugleich an die Kanten in allen Fotos an und macht die Leitung durchgängig. Drücken Sie im Fenster „Ausgleichen“, sehen Sie an, was sich ändern würde, und übernehmen Sie es mit OK.</translation>
        </message>
        <message>
            <source>The components have changed: adjust them again.</source>
            <translation>Die Bauteile haben sich geändert: Gleichen Sie sie noch einmal aus.</translation>
        </message>
        <message>
            <source>The components have changed: compare them again.</source>
            <translation>Die Bauteile haben sich geändert: Vergleichen Sie sie noch einmal.</translation>
        </message>
        <message>
            <source>The components have changed: put the stations together again.</source>
            <translation>Die Bauteile haben sich geändert: Führen Sie die Standpunkte noch einmal zusammen.</translation>
        </message>
        <message>
            <source>The distance in standard deviations; 4 and more does not fit</source>
            <translation>Der Abstand in Standardabweichungen; ab 4 passt er nicht</translation>
        </message>
        <message>
            <source>The flange facing it, too</source>
            <translation>Auch den Gegenflansch</translation>
        </message>
        <message>
            <source>The model as designed</source>
            <translation>Das geplante Modell</translation>
        </message>
        <message>
            <source>The next thickness that merchants keep in stock</source>
            <translation>Die nächste Dicke, die der Handel vorrätig hat</translation>
        </message>
        <message>
            <source>The photo window shows the station's photographs side by side. Turn the wheel to zoom at the pointer, drag with the middle button to move the photographs.</source>
            <translation>Das Fotofenster zeigt die Fotos des Standpunkts nebeneinander. Das Mausrad zoomt am Mauszeiger, mit gedrückter mittlerer Taste verschieben Sie die Fotos.</translation>
        </message>
        <message>
            <source>The photographs are not shown: {packages} is missing</source>
            <translation>Die Fotos werden nicht gezeigt: {packages} fehlt</translation>
        </message>
        <message>
            <source>The pipes that the clicks can mean, the likeliest first: outside diameter, distance, and the quality, which is the mean distance of the image's edges from the contours</source>
            <translation>Die Rohre, die die Klicks meinen können, das wahrscheinlichste zuerst: Außendurchmesser, Entfernung und die Güte, also der mittlere Abstand der Bildkanten von den Konturen</translation>
        </message>
        <message>
            <source>The preferences are not changed. {error}</source>
            <translation>Die Einstellungen bleiben, wie sie waren. {error}</translation>
        </message>
        <message>
            <source>The report's heading, such as the project's name</source>
            <translation>Die Überschrift des Berichts, etwa der Name des Projekts</translation>
        </message>
        <message>
            <source>The station fits at several places: look at each in the 3D view and choose</source>
            <translation>Der Standpunkt passt an mehreren Orten: Sehen Sie sich jeden in der 3D-Ansicht an und wählen Sie</translation>
        </message>
        <message>
            <source>The station that stays where it is</source>
            <translation>Der Standpunkt, der bleibt, wo er ist</translation>
        </message>
        <message>
            <source>The table for a spreadsheet</source>
            <translation>Die Tabelle für eine Tabellenkalkulation</translation>
        </message>
        <message>
            <source>There is no flange to accept yet.</source>
            <translation>Es gibt noch keinen Flansch zu übernehmen.</translation>
        </message>
        <message>
            <source>There is no pipe to accept yet.</source>
            <translation>Es gibt noch kein Rohr zu übernehmen.</translation>
        </message>
        <message>
            <source>These files of station {station} are not where they were:</source>
            <translation type="vanished">Diese Dateien des Standpunkts {station} sind nicht mehr, wo sie waren:</translation>
        </message>
        <message>
            <source>They make most of the file's size</source>
            <translation>Sie machen den größten Teil der Datei aus</translation>
        </message>
        <message>
            <source>Thicker pipes are not looked for</source>
            <translation>Dickere Rohre werden nicht gesucht</translation>
        </message>
        <message>
            <source>Thickness</source>
            <translation>Dicke</translation>
        </message>
        <message>
            <source>Thickness of the second layer</source>
            <translation>Dicke der zweiten Lage</translation>
        </message>
        <message>
            <source>Thickness of the sheet metal</source>
            <translation>Dicke des Blechs</translation>
        </message>
        <message>
            <source>Thinner pipes are not looked for</source>
            <translation>Dünnere Rohre werden nicht gesucht</translation>
        </message>
        <message>
            <source>Threads</source>
            <translation>Threads</translation>
        </message>
        <message>
            <source>Tick the pipes from this confidence on: how much likelier they are than chance, as a logarithm</source>
            <translation>Die Rohre ab dieser Sicherheit ankreuzen: wievielmal wahrscheinlicher als Zufall sie sind, als Logarithmus</translation>
        </message>
        <message>
            <source>Tight bends</source>
            <translation>Enge Bögen</translation>
        </message>
        <message>
            <source>To check by eye: the photographs with what was measured drawn on them</source>
            <translation>Zum Prüfen mit dem Auge: die Fotos, darin gezeichnet, was gemessen wurde</translation>
        </message>
        <message>
            <source>To look at and print: the sheets with their parts</source>
            <translation>Zum Ansehen und Drucken: die Tafeln mit ihren Teilen</translation>
        </message>
        <message>
            <source>Tolerances</source>
            <translation>Toleranzen</translation>
        </message>
        <message>
            <source>Too close</source>
            <translation>Zu nah</translation>
        </message>
        <message>
            <source>Turn °</source>
            <translation>Drehung °</translation>
        </message>
        <message>
            <source>Type</source>
            <translation>Typ</translation>
        </message>
        <message>
            <source>Types and pressure classes, the likeliest first; the score is the logarithm of how likely the images make them, those without one were not compared with the images</source>
            <translation>Typen und Druckstufen, die wahrscheinlichsten zuerst; die Wertung ist der Logarithmus davon, wie wahrscheinlich die Bilder sie machen; die ohne wurden nicht mit den Bildern verglichen</translation>
        </message>
        <message>
            <source>Types and pressure classes, the likeliest first; those without a confidence were not compared with the images</source>
            <translation type="vanished">Typen und Druckstufen, die wahrscheinlichste zuerst; die ohne Sicherheit wurden nicht mit den Bildern verglichen</translation>
        </message>
        <message>
            <source>Up</source>
            <translation>Nach oben</translation>
        </message>
        <message>
            <source>Use</source>
            <translation>Nutzung</translation>
        </message>
        <message>
            <source>Version</source>
            <translation>Version</translation>
        </message>
        <message>
            <source>Warnings</source>
            <translation>Warnungen</translation>
        </message>
        <message>
            <source>What a click in a photograph means</source>
            <translation>Was ein Klick in einem Foto bedeutet</translation>
        </message>
        <message>
            <source>What and how</source>
            <translation>Was und wie</translation>
        </message>
        <message>
            <source>What and where to</source>
            <translation>Was und wohin</translation>
        </message>
        <message>
            <source>What does not fit</source>
            <translation>Was nicht passt</translation>
        </message>
        <message>
            <source>What is closer to the finished surface is listed as a clash</source>
            <translation>Was der fertigen Oberfläche näher ist, gilt als Kollision</translation>
        </message>
        <message>
            <source>What is done where the insulation is too thick for a bend's radius</source>
            <translation>Was geschieht, wo die Dämmung für den Radius eines Bogens zu dick ist</translation>
        </message>
        <message>
            <source>What is looked for</source>
            <translation>Was gesucht wird</translation>
        </message>
        <message>
            <source>What it sets free; a dash where the share of a kWh is not known</source>
            <translation>Was sie freisetzt; ein Strich, wo der Anteil einer kWh nicht bekannt ist</translation>
        </message>
        <message>
            <source>What that energy costs; a dash where its price is not known</source>
            <translation>Was diese Energie kostet; ein Strich, wo ihr Preis nicht bekannt ist</translation>
        </message>
        <message>
            <source>What the colours of the contours tell</source>
            <translation>Was die Farben der Konturen aussagen</translation>
        </message>
        <message>
            <source>What the first and the last piece reach over the pipe</source>
            <translation>Was das erste und das letzte Segment über das Rohr reichen</translation>
        </message>
        <message>
            <source>What they share</source>
            <translation>Gemeinsames</translation>
        </message>
        <message>
            <source>What was found; ticked ones are accepted together</source>
            <translation>Was gefunden wurde; Angekreuztes wird zusammen übernommen</translation>
        </message>
        <message>
            <source>Where the model has other coordinates than the document; else both are compared as they stand</source>
            <translation>Wenn das Modell andere Koordinaten hat als das Dokument; sonst werden beide verglichen, wie sie stehen</translation>
        </message>
        <message>
            <source>Where the point under the pointer lies in the other photographs, from near to far</source>
            <translation>Wo der Punkt unter dem Mauszeiger in den anderen Fotos liegt, von nah bis fern</translation>
        </message>
        <message>
            <source>Where the search does not find it: say that the two selected components, one of each station, are the same</source>
            <translation>Wo die Suche es nicht findet: angeben, dass die beiden ausgewählten Bauteile, je eines pro Standpunkt, dasselbe sind</translation>
        </message>
        <message>
            <source>Whether it still counts</source>
            <translation>Ob es noch zählt</translation>
        </message>
        <message>
            <source>Which diameters are possible: those of the standard, any, or a certain one</source>
            <translation>Welche Durchmesser möglich sind: die der Norm, beliebige oder ein bestimmter</translation>
        </message>
        <message>
            <source>While in operation</source>
            <translation>Im Betrieb</translation>
        </message>
        <message>
            <source>Wind</source>
            <translation>Wind</translation>
        </message>
        <message>
            <source>With a bend radius of {radius:g} mm nothing would be left of a pipe beside it.</source>
            <translation>Bei einem Biegeradius von {radius:g} mm bliebe von einem Rohr daneben nichts übrig.</translation>
        </message>
        <message>
            <source>With insulation</source>
            <translation>Mit Dämmung</translation>
        </message>
        <message>
            <source>Within the standard's tolerances</source>
            <translation>Innerhalb der Toleranzen der Norm</translation>
        </message>
        <message>
            <source>Without it</source>
            <translation>Ohne sie</translation>
        </message>
        <message>
            <source>Write the flat parts of the jacket, laid out on sheets</source>
            <translation>Die Abwicklungen des Blechmantels schreiben, auf Tafeln verteilt</translation>
        </message>
        <message>
            <source>Write the list of parts, sheets and material</source>
            <translation>Die Liste der Teile, Tafeln und des Materials schreiben</translation>
        </message>
        <message>
            <source>Write the pipeline as IFC for BIM, as STEP solids or as a table.</source>
            <translation>Schreiben Sie die Rohrleitung als IFC für BIM, als STEP-Körper oder als Tabelle.</translation>
        </message>
        <message>
            <source>Written: {path}</source>
            <translation>Geschrieben: {path}</translation>
        </message>
        <message>
            <source>all</source>
            <translation>alle</translation>
        </message>
        <message>
            <source>all ({count})</source>
            <translation>alle ({count})</translation>
        </message>
        <message>
            <source>all components ({count})</source>
            <translation>alle Bauteile ({count})</translation>
        </message>
        <message>
            <source>always an edge</source>
            <translation>immer eine Kante</translation>
        </message>
        <message>
            <source>always the inside</source>
            <translation>immer das Innere</translation>
        </message>
        <message>
            <source>an edge where one is marked, else the inside</source>
            <translation>eine Kante, wo eine markiert ist, sonst das Innere</translation>
        </message>
        <message>
            <source>another task is open in the task panel</source>
            <translation>im Aufgabenbereich ist eine andere Aufgabe offen</translation>
        </message>
        <message>
            <source>any (free)</source>
            <translation>beliebig (frei)</translation>
        </message>
        <message>
            <source>as entered below</source>
            <translation>wie unten eingegeben</translation>
        </message>
        <message>
            <source>as it is ({count})</source>
            <translation>wie bisher ({count})</translation>
        </message>
        <message>
            <source>as long as the others</source>
            <translation>so lang wie die anderen</translation>
        </message>
        <message>
            <source>as the specification says</source>
            <translation>wie in der Spezifikation</translation>
        </message>
        <message>
            <source>bare</source>
            <translation>ungedämmt</translation>
        </message>
        <message>
            <source>beyond</source>
            <translation>darüber</translation>
        </message>
        <message>
            <source>blind</source>
            <translation>blind</translation>
        </message>
        <message>
            <source>boxes</source>
            <translation>Kappen</translation>
        </message>
        <message>
            <source>by DIN 4140</source>
            <translation>nach DIN 4140</translation>
        </message>
        <message>
            <source>by heat loss</source>
            <translation>nach Wärmeverlust</translation>
        </message>
        <message>
            <source>by kind</source>
            <translation>nach Art</translation>
        </message>
        <message>
            <source>by quality</source>
            <translation>nach Güte</translation>
        </message>
        <message>
            <source>by rule</source>
            <translation>nach Regel</translation>
        </message>
        <message>
            <source>by surface temperature</source>
            <translation>nach Oberflächentemperatur</translation>
        </message>
        <message>
            <source>choose the model as designed</source>
            <translation>wählen Sie das geplante Modell</translation>
        </message>
        <message>
            <source>closed, for what it worked on was deleted</source>
            <translation>geschlossen, denn woran gearbeitet wurde, ist gelöscht</translation>
        </message>
        <message>
            <source>comparing with the model</source>
            <translation>Vergleich mit dem Modell</translation>
        </message>
        <message>
            <source>converged</source>
            <translation>konvergiert</translation>
        </message>
        <message>
            <source>counts</source>
            <translation>zählt</translation>
        </message>
        <message>
            <source>designed {designed:.1f} mm, difference {difference:+.1f} mm</source>
            <translation>geplant {designed:.1f} mm, Unterschied {difference:+.1f} mm</translation>
        </message>
        <message>
            <source>did not converge</source>
            <translation>nicht konvergiert</translation>
        </message>
        <message>
            <source>does not fit</source>
            <translation>passt nicht</translation>
        </message>
        <message>
            <source>exact</source>
            <translation>genau</translation>
        </message>
        <message>
            <source>finding edges</source>
            <translation>Kanten werden gesucht</translation>
        </message>
        <message>
            <source>finding edges...</source>
            <translation>Kanten werden gesucht ...</translation>
        </message>
        <message>
            <source>finish it first</source>
            <translation>beenden Sie es zuerst</translation>
        </message>
        <message>
            <source>finish or close it first</source>
            <translation>beenden oder schließen Sie sie zuerst</translation>
        </message>
        <message>
            <source>fixed</source>
            <translation>festgelegt</translation>
        </message>
        <message>
            <source>follows from its pipes</source>
            <translation>folgt aus seinen Rohren</translation>
        </message>
        <message>
            <source>free</source>
            <translation>frei</translation>
        </message>
        <message>
            <source>give at least one layer</source>
            <translation>geben Sie mindestens eine Lage an</translation>
        </message>
        <message>
            <source>give one</source>
            <translation>geben Sie einen an</translation>
        </message>
        <message>
            <source>grey {value}</source>
            <translation>Grauwert {value}</translation>
        </message>
        <message>
            <source>half as long as the others</source>
            <translation>halb so lang wie die anderen</translation>
        </message>
        <message>
            <source>is</source>
            <translation>ist</translation>
        </message>
        <message>
            <source>its document was closed</source>
            <translation>sein Dokument wurde geschlossen</translation>
        </message>
        <message>
            <source>its photographs are missing</source>
            <translation>seine Fotos fehlen</translation>
        </message>
        <message>
            <source>kWh/a</source>
            <translation>kWh/a</translation>
        </message>
        <message>
            <source>last seen in {folder}</source>
            <translation>zuletzt in {folder}</translation>
        </message>
        <message>
            <source>left out</source>
            <translation>ausgeschlossen</translation>
        </message>
        <message>
            <source>longer than the half</source>
            <translation>länger als die Hälfte</translation>
        </message>
        <message>
            <source>loose plate</source>
            <translation>lose</translation>
        </message>
        <message>
            <source>loose plate, neck</source>
            <translation>lose, mit Bund</translation>
        </message>
        <message>
            <source>model.ifc</source>
            <translation>modell.ifc</translation>
        </message>
        <message>
            <source>no component is selected</source>
            <translation>kein Bauteil ist ausgewählt</translation>
        </message>
        <message>
            <source>no solid is selected</source>
            <translation>kein Körper ist ausgewählt</translation>
        </message>
        <message>
            <source>none</source>
            <translation>keine</translation>
        </message>
        <message>
            <source>not determined</source>
            <translation>nicht bestimmt</translation>
        </message>
        <message>
            <source>not known</source>
            <translation>nicht bekannt</translation>
        </message>
        <message>
            <source>not trusted</source>
            <translation>ohne Gewicht</translation>
        </message>
        <message>
            <source>not two components of two stations are selected</source>
            <translation>es sind nicht zwei Bauteile zweier Standpunkte ausgewählt</translation>
        </message>
        <message>
            <source>nothing is insulated like this</source>
            <translation>so wird nichts gedämmt</translation>
        </message>
        <message>
            <source>nothing was put together yet</source>
            <translation>es wurde noch nichts zusammengeführt</translation>
        </message>
        <message>
            <source>now</source>
            <translation>jetzt</translation>
        </message>
        <message>
            <source>of the standard</source>
            <translation>der Norm</translation>
        </message>
        <message>
            <source>open it again</source>
            <translation>öffnen Sie es wieder</translation>
        </message>
        <message>
            <source>open one, or import a station first</source>
            <translation>öffnen Sie eines oder importieren Sie zuerst einen Standpunkt</translation>
        </message>
        <message>
            <source>planning the insulation</source>
            <translation>die Dämmung wird geplant</translation>
        </message>
        <message>
            <source>plate</source>
            <translation>glatt</translation>
        </message>
        <message>
            <source>press Adjust first</source>
            <translation>drücken Sie zuerst „Ausgleichen“</translation>
        </message>
        <message>
            <source>press Find What They Share first</source>
            <translation>drücken Sie zuerst „Gemeinsames suchen“</translation>
        </message>
        <message>
            <source>px in photographs, mm or degrees of conditions</source>
            <translation>px in Fotos, mm oder Grad bei Bedingungen</translation>
        </message>
        <message>
            <source>q px</source>
            <translation>q px</translation>
        </message>
        <message>
            <source>reading...</source>
            <translation>wird gelesen ...</translation>
        </message>
        <message>
            <source>refuse</source>
            <translation>ablehnen</translation>
        </message>
        <message>
            <source>runs of the selected ({count})</source>
            <translation>Stränge der ausgewählten ({count})</translation>
        </message>
        <message>
            <source>saved</source>
            <translation>gespart</translation>
        </message>
        <message>
            <source>say where they are in its photo window</source>
            <translation>geben Sie in seinem Fotofenster an, wo sie sind</translation>
        </message>
        <message>
            <source>segmented</source>
            <translation>aus Segmenten</translation>
        </message>
        <message>
            <source>select one of each (Ctrl and click)</source>
            <translation>wählen Sie je eines aus (Strg und Klick)</translation>
        </message>
        <message>
            <source>select some, or adjust all</source>
            <translation>wählen Sie welche aus oder gleichen Sie alle aus</translation>
        </message>
        <message>
            <source>select some, or compare all</source>
            <translation>wählen Sie welche aus oder vergleichen Sie alle</translation>
        </message>
        <message>
            <source>select some, or export all</source>
            <translation>wählen Sie welche aus oder exportieren Sie alle</translation>
        </message>
        <message>
            <source>select some, or insulate all</source>
            <translation>wählen Sie welche aus oder dämmen Sie alle</translation>
        </message>
        <message>
            <source>select the solids as designed in the tree or in 3D</source>
            <translation>wählen Sie die geplanten Körper im Baum oder in 3D aus</translation>
        </message>
        <message>
            <source>selected ({count})</source>
            <translation>ausgewählte ({count})</translation>
        </message>
        <message>
            <source>selected components ({count})</source>
            <translation>ausgewählte Bauteile ({count})</translation>
        </message>
        <message>
            <source>slip-on</source>
            <translation>Überschieb</translation>
        </message>
        <message>
            <source>smooth</source>
            <translation>rund</translation>
        </message>
        <message>
            <source>there is no IFC file</source>
            <translation>es gibt keine IFC-Datei</translation>
        </message>
        <message>
            <source>there is no document</source>
            <translation>es gibt kein Dokument</translation>
        </message>
        <message>
            <source>there is no file name</source>
            <translation>es gibt keinen Dateinamen</translation>
        </message>
        <message>
            <source>there is no result yet</source>
            <translation>es gibt noch kein Ergebnis</translation>
        </message>
        <message>
            <source>threaded</source>
            <translation>Gewinde</translation>
        </message>
        <message>
            <source>to</source>
            <translation>an</translation>
        </message>
        <message>
            <source>two pieces with a mitre</source>
            <translation>zwei Stücke auf Gehrung</translation>
        </message>
        <message>
            <source>up to</source>
            <translation>bis</translation>
        </message>
        <message>
            <source>w</source>
            <translation>w</translation>
        </message>
        <message>
            <source>weak</source>
            <translation>schwach</translation>
        </message>
        <message>
            <source>weld neck</source>
            <translation>Vorschweiß</translation>
        </message>
        <message>
            <source>with this insulation</source>
            <translation>mit dieser Dämmung</translation>
        </message>
        <message>
            <source>within their tolerances</source>
            <translation>innerhalb ihrer Toleranzen</translation>
        </message>
        <message>
            <source>writing {path}</source>
            <translation>{path} wird geschrieben</translation>
        </message>
        <message>
            <source>written: {path}</source>
            <translation>geschrieben: {path}</translation>
        </message>
        <message>
            <source>{component} is weakly placed (σ {sigma:.1f} mm): {reason}</source>
            <translation>{component} liegt unsicher (σ {sigma:.1f} mm): {reason}</translation>
        </message>
        <message>
            <source>{count} beyond</source>
            <translation>{count} darüber</translation>
        </message>
        <message>
            <source>{count} components insulated</source>
            <translation>{count} Bauteile gedämmt</translation>
        </message>
        <message>
            <source>{count} found. Click on one to choose it.</source>
            <translation>{count} gefunden. Klicken Sie einen an, um ihn zu wählen.</translation>
        </message>
        <message>
            <source>{count} up to {limit:g} mm</source>
            <translation>{count} bis {limit:g} mm</translation>
        </message>
        <message>
            <source>{count} within {limit:g} mm</source>
            <translation>{count} innerhalb von {limit:g} mm</translation>
        </message>
        <message>
            <source>{count} without counterpart</source>
            <translation>{count} ohne Gegenstück</translation>
        </message>
        <message>
            <source>{diameter:g} mm, as entered</source>
            <translation>{diameter:g} mm, wie eingegeben</translation>
        </message>
        <message>
            <source>{pieces} pieces over {length:.1f} m: {volume:.3f} m³ of insulation, {area:.2f} m² of jacket</source>
            <translation>{pieces} Stücke auf {length:.1f} m: {volume:.3f} m³ Dämmung, {area:.2f} m² Mantel</translation>
        </message>
        <message>
            <source>{station} ({count} components)</source>
            <translation>{station} ({count} Bauteile)</translation>
        </message>
        <message>
            <source>{station} - photographs</source>
            <translation>{station} - Fotos</translation>
        </message>
        <message>
            <source>{station} in {reference}, place {place}: {count} components fit (score {score:.1f})</source>
            <translation>{station} in {reference}, Ort {place}: {count} Bauteile passen (Wertung {score:.1f})</translation>
        </message>
        <message>
            <source>{station}: these photographs are not where they were</source>
            <translation>{station}: diese Fotos sind nicht mehr, wo sie waren</translation>
        </message>
        <message>
            <source>{what} failed ({error}); the report view has the details, please report them</source>
            <translation>{what}: Fehler ({error}); Einzelheiten stehen im Ausgabefenster, bitte melden Sie sie</translation>
        </message>
        <message>
            <source>{what} needs {package}, which cannot be loaded here ({reason}); install it anew with: {how}</source>
            <translation>{what} braucht {package}, das sich hier nicht laden lässt ({reason}); installieren Sie es neu mit: {how}</translation>
        </message>
        <message>
            <source>{what} needs {package}, which is not installed here; install it with: {how} - and start FreeCAD again</source>
            <translation>{what} braucht {package}, das hier nicht installiert ist; installieren Sie es mit: {how} - und starten Sie FreeCAD neu</translation>
        </message>
        <message>
            <source>{what}: cancelled</source>
            <translation>{what}: abgebrochen</translation>
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
            <translation>Hilfe zur Pipe Workbench</translation>
        </message>
        <message>
            <source>Pipe adjustment</source>
            <translation>Rohre ausgleichen</translation>
        </message>
        <message>
            <source>Pipe measuring</source>
            <translation>Rohre messen</translation>
        </message>
        <message>
            <source>Pipe output</source>
            <translation>Rohre ausgeben</translation>
        </message>
    </context>
</TS>
